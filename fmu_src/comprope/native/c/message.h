/* Error messages, built piece by piece; what does not fit is cut and marked. */
#ifndef MESSAGE_H
#define MESSAGE_H

#include <stddef.h>

enum { MESSAGE_SIZE = 2048 };

typedef struct {
    size_t length;
    char chars[MESSAGE_SIZE];
} Message;

void message_clear(Message *message);
void message_add(Message *message, const char *format, ...);

/* Begin one more problem: adds "; " if there is one already. */
void message_next(Message *message);

/* Add a number in six digits; "nan" and "inf" are written the same on every system. */
void message_number(Message *message, double number);

/* Write a sentence as a format of printf, in which a percent sign is written twice; it is cut to `size`. */
void message_as_format(const char *sentence, char *format, size_t size);

#endif

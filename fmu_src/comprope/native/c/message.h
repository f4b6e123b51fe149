/* Sentences for the importer, put together piece by piece; what does not fit is cut and marked. */
#ifndef TEXT_H
#define TEXT_H

#include <stddef.h>

enum { TEXT_SIZE = 2048 };

typedef struct {
    size_t length;
    char chars[TEXT_SIZE];
} Text;

void text_clear(Text *text);
void text_add(Text *text, const char *format, ...);

/* Begin one more problem: a "; " where there is one already. */
void text_next(Text *text);

/* Add a number in six digits; "nan" and "inf" look the same on every system. */
void text_number(Text *text, double number);

#endif

#include "message.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char CUT[] = " ...";

void message_clear(Message *message)
{
    message->length = 0;
    message->chars[0] = '\0';
}

void message_add(Message *message, const char *format, ...)
{
    const size_t room = sizeof message->chars - message->length;
    va_list arguments;

    va_start(arguments, format);
    const int wanted = vsnprintf(message->chars + message->length, room, format, arguments);
    va_end(arguments);
    if (wanted < 0) {
        message->chars[message->length] = '\0';
    } else if ((size_t)wanted < room) {
        message->length += (size_t)wanted;
    } else {
        message->length = sizeof message->chars - 1;
        memcpy(message->chars + sizeof message->chars - sizeof CUT, CUT, sizeof CUT);
    }
}

void message_next(Message *message)
{
    if (message->length) {
        message_add(message, "; ");
    }
}

void message_number(Message *message, double number)
{
    if (isnan(number)) {
        message_add(message, "nan");
    } else if (isinf(number)) {
        message_add(message, number > 0.0 ? "inf" : "-inf");
    } else {
        message_add(message, "%.6g", number);
    }
}

void message_as_format(const char *sentence, char *format, size_t size)
{
    size_t length = 0;
    for (; *sentence && length < size - 2; sentence++) {
        format[length++] = *sentence;
        if (*sentence == '%') {
            format[length++] = '%';
        }
    }
    format[length] = '\0';
}

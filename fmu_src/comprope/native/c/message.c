#include "message.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char CUT[] = " ...";

void text_clear(Text *text)
{
    text->length = 0;
    text->chars[0] = '\0';
}

void text_add(Text *text, const char *format, ...)
{
    const size_t room = sizeof text->chars - text->length;
    va_list arguments;

    va_start(arguments, format);
    const int wanted = vsnprintf(text->chars + text->length, room, format, arguments);
    va_end(arguments);
    if (wanted < 0) {
        text->chars[text->length] = '\0';
    } else if ((size_t)wanted < room) {
        text->length += (size_t)wanted;
    } else {
        text->length = sizeof text->chars - 1;
        memcpy(text->chars + sizeof text->chars - sizeof CUT, CUT, sizeof CUT);
    }
}

void text_next(Text *text)
{
    if (text->length) {
        text_add(text, "; ");
    }
}

void text_number(Text *text, double number)
{
    if (isnan(number)) {
        text_add(text, "nan");
    } else if (isinf(number)) {
        text_add(text, number > 0.0 ? "inf" : "-inf");
    } else {
        text_add(text, "%.6g", number);
    }
}

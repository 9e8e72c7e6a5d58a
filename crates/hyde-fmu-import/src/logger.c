/* The logger of FMI 2.0: formats the message as printf does and hands it to the Rust side, whose function the environment
   begins with. */
#include <stdarg.h>
#include <stdio.h>

struct environment {
    void (*logged)(void *environment, unsigned status, const char *message);
};

void hyde_fmu_logger(void *environment, const char *instance, unsigned status, const char *category,
                     const char *format, ...) {
    char text[2048];
    va_list arguments;
    (void)instance;
    (void)category;
    if (environment == NULL || format == NULL) return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ((struct environment *)environment)->logged(environment, status, text);
}

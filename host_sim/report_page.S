/* The report's parts, as they lie on disk, inside the program. */
#define EMBED(name, path)                                                                          \
    .global name;                                                                                  \
    .global name##_end;                                                                            \
    name:                                                                                          \
    .incbin path;                                                                                  \
    name##_end:                                                                                    \
    .byte 0

    .section .rodata
    EMBED(report_template, REPORT_TEMPLATE)
    EMBED(report_chart_js, REPORT_CHART_JS)
    .section .note.GNU-stack,"",%progbits

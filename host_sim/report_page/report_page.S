/* report_page.S - the report's parts, as they lie on disk, inside the program: name and name_end. */
    .section .rodata

    .global report_page_html, report_page_html_end
report_page_html:
    .incbin "page.html"
report_page_html_end:

    .global report_style_css, report_style_css_end
report_style_css:
    .incbin "style.css"
report_style_css_end:

    .global report_script_js, report_script_js_end
report_script_js:
    .incbin "data.js"
    .incbin "view.js"
    .incbin "touch.js"
    .incbin "charts.js"
    .incbin "page.js"
report_script_js_end:

    .global report_chart_js, report_chart_js_end
report_chart_js:
    .incbin CHART_JS
report_chart_js_end:

    .section .note.GNU-stack,"",%progbits

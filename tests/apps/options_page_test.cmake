# Compares a page with what `hgmm-map options --markdown` writes.
#   cmake -DPROGRAM=build/bin/hgmm-map -DPAGE=docs/options.md -P options_page_test.cmake
execute_process(COMMAND ${PROGRAM} options --markdown
    OUTPUT_VARIABLE WRITTEN RESULT_VARIABLE RESULT)
if(NOT RESULT EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} options --markdown: exit code ${RESULT}")
endif()
file(READ ${PAGE} PAGE_TEXT)
if(NOT WRITTEN STREQUAL PAGE_TEXT)
    message(FATAL_ERROR "${PAGE} is not current. Write it anew:\n"
        "    ${PROGRAM} options --markdown > ${PAGE}")
endif()

# Each step's failure fails the test. What it printed is in STEP_OUTPUT.
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "failed (${code}): ${ARGN}\n${out}")
    endif()
    set(STEP_OUTPUT "${out}" PARENT_SCOPE)
endfunction()

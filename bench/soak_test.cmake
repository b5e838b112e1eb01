# A short soak runs to its end, and a state of another run is refused.
set(STATE soak_test.state)
file(REMOVE ${STATE})
foreach(RUN 1 2)
    execute_process(COMMAND ${PROGRAM} 2d --scans 100 --state ${STATE}
        OUTPUT_VARIABLE OUT_${RUN} ERROR_VARIABLE ERR RESULT_VARIABLE CODE)
    # 1: the map of so few scans still grows.
    if(NOT CODE MATCHES "^[01]$" OR ERR)
        message(FATAL_ERROR "run ${RUN}: ${CODE} ${ERR}")
    endif()
endforeach()
string(REGEX MATCHALL "\n" LINES "${OUT_1}")
list(LENGTH LINES COUNT)
if(NOT COUNT EQUAL 12 OR NOT OUT_1 STREQUAL OUT_2)
    message(FATAL_ERROR "expected ten tenths, the second time as they were:\n${OUT_1}${OUT_2}")
endif()
execute_process(COMMAND ${PROGRAM} rings --scans 100 --state ${STATE}
    ERROR_VARIABLE ERR RESULT_VARIABLE CODE)
if(NOT CODE EQUAL 1 OR NOT ERR MATCHES "another kind")
    message(FATAL_ERROR "a state of another run: ${CODE} ${ERR}")
endif()
file(REMOVE ${STATE})

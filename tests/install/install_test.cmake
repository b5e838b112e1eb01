# Each step's failure fails the test.
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "failed (${code}): ${ARGN}\n${out}")
    endif()
    set(STEP_OUTPUT "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
step(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_FLAGS=${CXX_FLAGS})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
foreach(consumer core plugin)
    step(${WORK_DIR}/build/consumer-${consumer})
    if(NOT STEP_OUTPUT MATCHES "consumer-${consumer}: [1-9][0-9]* component")
        message(FATAL_ERROR "consumer-${consumer} printed: ${STEP_OUTPUT}")
    endif()
endforeach()
foreach(installed
        bin/hgmm-replay bin/hgmm-import bin/hgmm-map
        share/mrpt-hgmm/config_files/pf-localization.ini)
    if(NOT EXISTS ${WORK_DIR}/prefix/${installed})
        message(FATAL_ERROR "not installed: ${installed}")
    endif()
endforeach()
step(${WORK_DIR}/prefix/bin/hgmm-map --help)

include(${CMAKE_CURRENT_LIST_DIR}/step.cmake)

file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
# The program of docs/use-in-your-app.md, as it stands there.
file(READ ${CONSUMER_DIR}/../../../docs/use-in-your-app.md PAGE)
if(NOT PAGE MATCHES "```cpp\n([^`]*)```")
    message(FATAL_ERROR "docs/use-in-your-app.md has no C++ program")
endif()
file(WRITE ${WORK_DIR}/documented.cpp "${CMAKE_MATCH_1}")
step(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja
    -DDOCUMENTED=${WORK_DIR}/documented.cpp
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_FLAGS=${CXX_FLAGS})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
foreach(consumer core plugin)
    step(${WORK_DIR}/build/consumer-${consumer})
    if(NOT STEP_OUTPUT MATCHES "consumer-${consumer}: [1-9][0-9]* component")
        message(FATAL_ERROR "consumer-${consumer} printed: ${STEP_OUTPUT}")
    endif()
endforeach()
step(${CMAKE_COMMAND} -E chdir ${WORK_DIR} build/consumer-documented)
if(NOT STEP_OUTPUT MATCHES "P\\(occupied\\) = 0\\.[5-9]" OR NOT EXISTS ${WORK_DIR}/map.hgmm)
    message(FATAL_ERROR "consumer-documented printed: ${STEP_OUTPUT}")
endif()
foreach(installed
        bin/hgmm-replay bin/hgmm-import bin/hgmm-map bin/hgmm-localise
        share/mrpt-hgmm/config_files/pf-localization.ini)
    if(NOT EXISTS ${WORK_DIR}/prefix/${installed})
        message(FATAL_ERROR "not installed: ${installed}")
    endif()
endforeach()
step(${WORK_DIR}/prefix/bin/hgmm-map --help)

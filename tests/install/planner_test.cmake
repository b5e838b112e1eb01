# Builds examples/planner against an install, and plans in a map of two simulated rooms.
if(NOT OMPL_FOUND)
    message("SKIPPED: examples/planner needs libompl-dev")
    return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/step.cmake)

set(RADIUS 0.25)
set(DOOR --from=-2.5,-1.5,1.2 --to=3,-1.8,1 --radius ${RADIUS} --seed 3)

# Paths must be clear of the walls by the radius, and not for want of paths.
function(expect_clear CSV)
    step(${WORK_DIR}/build/two-rooms clearance ${CSV})
    string(REGEX MATCH "clearance (-?[0-9.]+|inf)" ignored "${STEP_OUTPUT}")
    if(NOT CMAKE_MATCH_1 GREATER_EQUAL RADIUS)
        message(FATAL_ERROR "${CSV}: clearance ${CMAKE_MATCH_1} m, not ${RADIUS} m")
    endif()
endfunction()

# What is refused must be, in these words.
function(expect_refusal WORDS)
    execute_process(COMMAND ${PLAN} ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out
        ERROR_VARIABLE out)
    if(code EQUAL 0 OR NOT out MATCHES "${WORDS}")
        message(FATAL_ERROR "not refused with '${WORDS}' (${code}): ${ARGN}\n${out}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
step(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
set(PLAN ${WORK_DIR}/build/planner/plan)
set(MAP ${WORK_DIR}/two_rooms.hgmm)
step(${WORK_DIR}/build/two-rooms save ${MAP})

# Through the doorway; the same path again with the same seed.
foreach(run first second)
    step(${PLAN} ${MAP} ${DOOR} -o ${WORK_DIR}/${run}.csv)
    if(NOT STEP_OUTPUT MATCHES "1 of 1 found")
        message(FATAL_ERROR "no path through the doorway: ${STEP_OUTPUT}")
    endif()
endforeach()
expect_clear(${WORK_DIR}/first.csv)
step(${CMAKE_COMMAND} -E compare_files ${WORK_DIR}/first.csv ${WORK_DIR}/second.csv)

step(${PLAN} ${MAP} --random 3 --apart 2 --radius ${RADIUS} -o ${WORK_DIR}/random.csv)
if(NOT STEP_OUTPUT MATCHES "3 of 3 found")
    message(FATAL_ERROR "not all random plans were found: ${STEP_OUTPUT}")
endif()
expect_clear(${WORK_DIR}/random.csv)

# In walls and beyond them; a robot too wide for the doorway.
expect_refusal("cannot be at the goal" ${MAP} --from=-2,0,1 --to=0,-1,1 --radius ${RADIUS})
expect_refusal("cannot be at the start" ${MAP} --from=-6,0,1 --to=-2,0,1 --radius ${RADIUS})
expect_refusal("0 of 1 found" ${MAP} --from=-2,0,1.2 --to=2.5,1.5,1.2 --radius 0.6
    --max-iterations 2000)
expect_refusal("--from and --to" ${MAP} --radius ${RADIUS})

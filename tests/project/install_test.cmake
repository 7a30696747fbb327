# Installs the build tree, moves the installation somewhere else, and there builds and runs a consumer project
# through find_package and through pkg-config.
#
# cmake -D BUILD_DIR=... -D CONSUMER_DIR=... -D WORK_DIR=... -D COMPILER=... -P install_test.cmake

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status COMMAND_ECHO STDOUT)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "exit status ${status}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/installed)
set(prefix "${WORK_DIR}/moved prefix")
file(RENAME ${WORK_DIR}/installed ${prefix})

run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/find_package -G Ninja -D CMAKE_CXX_COMPILER=${COMPILER}
    -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/find_package)
run(${CMAKE_COMMAND} -E chdir ${WORK_DIR} ${WORK_DIR}/find_package/consumer)
run(${WORK_DIR}/find_package/engine_consumer)

file(GLOB_RECURSE pc_file ${prefix}/lamella.pc)
cmake_path(GET pc_file PARENT_PATH pc_dir)
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
file(GLOB shared_libraries ${prefix}/lib*/liblamella*.so ${prefix}/lib*/*/liblamella*.so)
if(NOT shared_libraries)
    set(static --static)
endif()
# The headers are no system headers here: they warn of nothing, whatever the consumer asks for.
set(packages lamella lamella-io)
set(sources engine main)
set(warnings -Werror -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow)
foreach(package source IN ZIP_LISTS packages sources)
    execute_process(COMMAND pkg-config ${static} --cflags --libs ${package} OUTPUT_VARIABLE flags
                    COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND ${flags})
    run(${COMPILER} -std=c++20 ${warnings} ${CONSUMER_DIR}/${source}.cpp -o ${WORK_DIR}/pkg_config_${source} ${flags})
endforeach()
foreach(library ${shared_libraries})
    # It exports what its public headers declare, and nothing of its own.
    execute_process(COMMAND nm --dynamic --defined-only --demangle ${library} OUTPUT_VARIABLE names
                    COMMAND_ERROR_IS_FATAL ANY)
    if(NOT names MATCHES " lamella::slice\\(" OR NOT names MATCHES " lamella::Mesh::" OR names MATCHES "lamella::(Executor|CutGraph|AtomicFile)::")
        message(FATAL_ERROR "${library} exports too little or too much:\n${names}")
    endif()
    cmake_path(GET library PARENT_PATH lib_dir)
    set(ENV{LD_LIBRARY_PATH} ${lib_dir})
endforeach()
foreach(source ${sources})
    run(${CMAKE_COMMAND} -E chdir ${WORK_DIR} ${WORK_DIR}/pkg_config_${source})
endforeach()
unset(ENV{LD_LIBRARY_PATH})
# The engine needs no library of files.
execute_process(COMMAND pkg-config --static --libs lamella OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
if(flags MATCHES "-l(lamella-io|expat|z|deflate)")
    message(FATAL_ERROR "the engine links more than it needs: ${flags}")
endif()

# The installed pages show their pictures, and no link of theirs is dead.
set(docs ${prefix}/share/doc/lamella)
foreach(page formats.md conventions.md viewer.md algorithms/sweep.md howto/embedding.md)
    if(NOT EXISTS ${docs}/docs/${page})
        message(FATAL_ERROR "${page} is not in share/doc/lamella/docs")
    endif()
endforeach()
file(GLOB_RECURSE pages ${docs}/*.md)
foreach(page ${pages})
    cmake_path(GET page PARENT_PATH folder)
    file(READ ${page} text)
    string(REPLACE "](" "\n@" text "${text}")
    string(REGEX REPLACE "[][;]" " " text "${text}") # a list's own characters
    string(REGEX MATCHALL "\n@[^ )#]+" links "${text}")
    foreach(link IN LISTS links)
        string(SUBSTRING "${link}" 2 -1 link)
        if(NOT link MATCHES "^[a-z]+:" AND NOT EXISTS "${folder}/${link}")
            message(FATAL_ERROR "${page} links to ${link}, which is not installed")
        endif()
    endforeach()
endforeach()
# Where the program has a viewer, other programs find it beside.
set(page ${BUILD_DIR}/viewer/viewer_page.cpp)
if(EXISTS ${page})
    file(STRINGS ${page} has_page REGEX "constexpr char page" LIMIT_COUNT 1)
endif()
if(has_page AND NOT EXISTS ${prefix}/share/lamella/viewer.html)
    message(FATAL_ERROR "the viewer is not in share/lamella")
endif()

run(${prefix}/bin/lamella --version)

# Builds the viewer where npm's registry cannot be reached: that must not fail, and must say why there is none.
# cmake -D NODE=... -D NPM=... -D SOURCE_DIR=viewer -D WORK_DIR=... -P no_registry_test.cmake

file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
set(page ${WORK_DIR}/viewer_page.cpp)

# Nothing listens on this port, and an empty cache does not help out.
set(ENV{npm_config_registry} http://127.0.0.1:9/)
set(ENV{npm_config_cache} ${WORK_DIR}/cache)
set(ENV{npm_config_fetch_retry_mintimeout} 10)
unset(ENV{npm_config_offline})
execute_process(
    COMMAND ${CMAKE_COMMAND} -D NODE=${NODE} -D NPM=${NPM} -D REQUIRED=AUTO -D SOURCE_DIR=${SOURCE_DIR}
            -D WORK_DIR=${WORK_DIR}/work -D PAGE=${page} "-DFILES=package.json;package-lock.json"
            -P ${SOURCE_DIR}/build_viewer.cmake
    RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "The build fails where the viewer's packages cannot be fetched (${status}):\n${out}")
endif()

set(cause "fetching its packages by npm failed when Lamella was built \\(request to http://127.0.0.1:9/[^\n]*\\)")
if(NOT out MATCHES "^No viewer: ${cause}[^\n]*\n$")
    message(FATAL_ERROR "Expected one line that names the cause, but the build says:\n${out}")
endif()
file(READ ${page} source)
if(NOT source MATCHES "${cause}")
    message(FATAL_ERROR "The program does not know the cause:\n${source}")
endif()

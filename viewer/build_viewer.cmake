# Builds the viewer in WORK_DIR from FILES of SOURCE_DIR and writes it into the source PAGE. Where that fails and
# REQUIRED is not ON, the build goes on with a program that has none and says why: a network may be missing, for instance.

function(try what)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK_DIR} RESULT_VARIABLE status OUTPUT_VARIABLE out
                                                                                     ERROR_VARIABLE out TIMEOUT 300)
    if(status EQUAL 0)
        return()
    endif()
    if(REQUIRED STREQUAL "ON")
        message(FATAL_ERROR "${what} failed (${status}):\n${out}")
    endif()
    # npm tells the cause in one line of many.
    set(cause "${status}")
    if(out MATCHES "request to [^\n]*")
        set(cause "${CMAKE_MATCH_0}")
    endif()
    set(why "${what} failed when Lamella was built (${cause})")
    message(NOTICE "No viewer: ${why}; all that was said is in ${WORK_DIR}/failed.log; delete ${PAGE} to try again")
    file(WRITE ${WORK_DIR}/failed.log "${out}")
    configure_file(${SOURCE_DIR}/no_viewer.cpp.in ${PAGE} @ONLY)
    file(TOUCH ${PAGE})
    set(failed TRUE PARENT_SCOPE)
endfunction()

# What is no longer in the list must not stay.
file(REMOVE_RECURSE ${WORK_DIR}/src)
foreach(file ${FILES})
    get_filename_component(folder ${file} DIRECTORY)
    file(COPY ${SOURCE_DIR}/${file} DESTINATION ${WORK_DIR}/${folder})
endforeach()

# Packages stay until the list of them changes.
file(SHA256 ${WORK_DIR}/package-lock.json wanted)
set(installed "")
if(EXISTS ${WORK_DIR}/installed)
    file(READ ${WORK_DIR}/installed installed)
endif()
if(NOT installed STREQUAL wanted)
    # Scripts of packages are not needed, and so not run.
    try("fetching its packages by npm" ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1
        --fetch-timeout=60000)
    if(failed)
        return()
    endif()
    file(WRITE ${WORK_DIR}/installed ${wanted})
endif()
try("building it by vite" ${NODE} node_modules/vite/bin/vite.js build --logLevel error)
if(failed)
    return()
endif()
try("embedding it" ${NODE} embed.mjs dist/index.html ${PAGE})

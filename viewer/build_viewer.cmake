# Builds the viewer in WORK_DIR from FILES of SOURCE_DIR and writes it into the source PAGE. Where that fails and
# REQUIRED is not ON, the build goes on with a program that has none: a network may be missing, for instance.

function(try what)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK_DIR} RESULT_VARIABLE status OUTPUT_VARIABLE out
                                                                                     ERROR_VARIABLE out TIMEOUT 300)
    if(status EQUAL 0)
        return()
    endif()
    if(REQUIRED STREQUAL "ON")
        message(FATAL_ERROR "${what} failed (${status}):\n${out}")
    endif()
    message(WARNING "${what} failed (${status}), so this build has no viewer and lamella view will say so. Delete "
                    "${PAGE} to try again.\n${out}")
    file(COPY_FILE ${SOURCE_DIR}/../app/no_viewer.cpp ${PAGE})
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
    try("npm ci" ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1
        --fetch-timeout=60000)
    if(failed)
        return()
    endif()
    file(WRITE ${WORK_DIR}/installed ${wanted})
endif()
try("vite build" ${NODE} node_modules/vite/bin/vite.js build --logLevel error)
if(failed)
    return()
endif()
try("embed.mjs" ${NODE} embed.mjs dist/index.html ${PAGE})

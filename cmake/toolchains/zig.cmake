# What the toolchain files for Zig's compiler have in common (tools/install_zig.sh). The file that includes this one has
# set `zig_target`, and `zig_libraries`, the folder of build/libraries.

set(zig_folder ${CMAKE_CURRENT_LIST_DIR}/../../.cache/zig/bin)
# Zig writes debug information and a table of all symbols unless it is told not to.
foreach(language C CXX)
    set(CMAKE_${language}_FLAGS_INIT "-target ${zig_target} -g0")
endforeach()
foreach(kind EXE MODULE)
    set(CMAKE_${kind}_LINKER_FLAGS_INIT -s)
endforeach()
set(CMAKE_C_COMPILER ${zig_folder}/zig-cc)
set(CMAKE_CXX_COMPILER ${zig_folder}/zig-c++)
set(CMAKE_AR ${zig_folder}/zig-ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${zig_folder}/zig-ranlib CACHE FILEPATH "")

set(LAMELLA_LIBRARIES ${CMAKE_CURRENT_LIST_DIR}/../../build/libraries/${zig_libraries})
if(EXISTS ${LAMELLA_LIBRARIES}/lib/libcpu_model.a)
    set(CMAKE_CXX_STANDARD_LIBRARIES ${LAMELLA_LIBRARIES}/lib/libcpu_model.a)
endif()
set(CMAKE_FIND_ROOT_PATH ${LAMELLA_LIBRARIES})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# What both processors of macOS have in common.

include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
# Zig has the headers and the names of the system's library; there is no SDK of Apple.
set(CMAKE_OSX_SYSROOT "")
set(CMAKE_OSX_DEPLOYMENT_TARGET "")
set(CMAKE_INSTALL_NAME_TOOL ${CMAKE_COMMAND}) # not used, since there are only static libraries

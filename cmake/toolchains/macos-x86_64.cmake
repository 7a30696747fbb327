# macOS 11 and later on x86-64, with Zig's compiler. tools/build_libraries.sh macos-x86_64 builds the libraries.

set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(zig_target x86_64-macos.11.0)
set(zig_libraries macos-x86_64)
include(${CMAKE_CURRENT_LIST_DIR}/macos.cmake)

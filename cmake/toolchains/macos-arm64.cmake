# macOS 11 and later on ARM64 (Apple silicon), with Zig's compiler. tools/build_libraries.sh macos-arm64 builds the libraries.

set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(zig_target aarch64-macos.11.0)
set(zig_libraries macos-arm64)
include(${CMAKE_CURRENT_LIST_DIR}/macos.cmake)

# An interface target that every target of this project links privately: language, warnings, sanitizers. It is never
# exported, so consumers are not affected.

add_library(lamella_options INTERFACE)
target_compile_features(lamella_options INTERFACE cxx_std_20)
target_compile_options(
    lamella_options
    INTERFACE -Wall
              -Wextra
              -Wpedantic
              # In a unity build, local names of a source would shadow those of others.
              $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
              -Wconversion
              -Wno-sign-conversion
              # Sizes and counts have 64 bits everywhere; where memory has 32, limits are checked before they are used.
              $<$<EQUAL:${CMAKE_SIZEOF_VOID_P},4>:-Wno-shorten-64-to-32>
              -Wnon-virtual-dtor
              -Woverloaded-virtual
              # Never fuses a*b+c, so that every processor computes the same bits (docs/conventions.md).
              -ffp-contract=off
              # Nothing reads the error numbers of square roots, which keep loops from using vectors.
              -fno-math-errno)
# GCC warns of uninitialised values in the code that its own sanitizers add, so warnings are no errors there.
if(MINGW)
    target_compile_options(lamella_options INTERFACE -include ${PROJECT_SOURCE_DIR}/src/system/windows/utf8_paths.hpp)
endif()
if(LAMELLA_WERROR AND NOT (LAMELLA_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
    target_compile_options(lamella_options INTERFACE -Werror)
endif()
if(LAMELLA_SANITIZE)
    # Targets with the property LAMELLA_UNSANITIZED are excluded.
    set(sanitized $<NOT:$<BOOL:$<TARGET_PROPERTY:LAMELLA_UNSANITIZED>>>)
    foreach(option -fsanitize=${LAMELLA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_compile_options(lamella_options INTERFACE $<${sanitized}:${option}>)
    endforeach()
    if(LAMELLA_SANITIZE MATCHES "undefined")
        # The address sanitizer finds these errors, or the code cannot make them; the checks take a quarter of the time
        # to compile.
        target_compile_options(lamella_options INTERFACE $<${sanitized}:-fno-sanitize=null,object-size,pointer-overflow,vptr>)
    endif()
    target_link_options(lamella_options INTERFACE -fsanitize=${LAMELLA_SANITIZE})
endif()

# Compiles the sources of a target as a unity build of a few at a time, since parsing headers takes longer than
# compiling sources. -D CMAKE_UNITY_BUILD=ON, for a build from nothing, joins many; OFF compiles each by itself.
function(lamella_compile_together target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "AT_A_TIME" "")
    if(CMAKE_UNITY_BUILD)
        math(EXPR arg_AT_A_TIME "2 * ${arg_AT_A_TIME}")
    endif()
    if(NOT DEFINED CMAKE_UNITY_BUILD OR CMAKE_UNITY_BUILD)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${arg_AT_A_TIME})
    endif()
endfunction()

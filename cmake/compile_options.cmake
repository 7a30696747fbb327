# One interface target that every target of this project links privately: language, warnings, sanitizers.
# It is never exported: nothing here reaches a consumer.

add_library(lamella_options INTERFACE)
target_compile_features(lamella_options INTERFACE cxx_std_20)
target_compile_options(
    lamella_options
    INTERFACE -Wall
              -Wextra
              -Wpedantic
              # In sources that are compiled together, names of their own would shadow those of others.
              $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
              -Wconversion
              -Wno-sign-conversion
              -Wnon-virtual-dtor
              -Woverloaded-virtual
              # The same bits on every processor: a*b+c is never fused (docs/conventions.md).
              -ffp-contract=off)
# GCC sees uninitialised values in the code that its own sanitizers add: there warnings stay warnings.
if(LAMELLA_WERROR AND NOT (LAMELLA_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
    target_compile_options(lamella_options INTERFACE -Werror)
endif()
if(LAMELLA_SANITIZE)
    # Not where a target has the property LAMELLA_UNSANITIZED.
    set(sanitized $<NOT:$<BOOL:$<TARGET_PROPERTY:LAMELLA_UNSANITIZED>>>)
    foreach(option -fsanitize=${LAMELLA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_compile_options(lamella_options INTERFACE $<${sanitized}:${option}>)
    endforeach()
    if(LAMELLA_SANITIZE MATCHES "undefined")
        # Addresses show their mistakes, or nothing here can make them; looking takes an eighth of compiling.
        target_compile_options(lamella_options INTERFACE $<${sanitized}:-fno-sanitize=null,object-size,vptr>)
    endif()
    target_link_options(lamella_options INTERFACE -fsanitize=${LAMELLA_SANITIZE})
endif()

# Compiles the sources of a target some at a time, since their headers take longer than they do. With
# -D CMAKE_UNITY_BUILD=ON, for a build from nothing, it is many; with OFF each is compiled by itself.
function(lamella_compile_together target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "AT_A_TIME" "")
    if(CMAKE_UNITY_BUILD)
        math(EXPR arg_AT_A_TIME "2 * ${arg_AT_A_TIME}")
    endif()
    if(NOT DEFINED CMAKE_UNITY_BUILD OR CMAKE_UNITY_BUILD)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${arg_AT_A_TIME})
    endif()
endfunction()

# Bundles of Lamplight in a build with CMake 3.21 or later.
#
#     list(APPEND CMAKE_PREFIX_PATH "DIR")       # the folder that has `cmake` and `include`
#     find_package(Lamplight REQUIRED)
#     lamplight_add_bundle(shaders MANIFEST shaders/lamplight.toml)
#     target_link_libraries(app PRIVATE shaders)
#
# `lamplight_add_bundle(NAME MANIFEST FILE ...)` makes a library that other targets link to. It writes
# NAME.lamplight, NAME_keys.h (typed keys) and NAME.h (structures and numbers of bindings) to a folder
# that is an include directory of these targets, as is the folder of lamplight.h. The bundle is made
# again when a file changes that the last run read.
#
#   MANIFEST FILE     the manifest
#   PROGRAM NAME      only this program
#   TARGETS T...      only these targets
#   LANGUAGE c|cpp    of NAME.h; c if it is left out
#   EMBED             NAME.h also has the bundle, as an array

if(CMAKE_VERSION VERSION_LESS 3.21)
  message(FATAL_ERROR "Lamplight needs CMake 3.21 or later")
endif()
# For the function below, whatever the project asks for: paths in DEPFILE depend on it.
cmake_policy(VERSION 3.21)

find_program(LAMPLIGHT_PROGRAM lamplight DOC "The command `lamplight`")
if(NOT LAMPLIGHT_PROGRAM)
  set(Lamplight_FOUND FALSE)
  set(Lamplight_NOT_FOUND_MESSAGE "the command `lamplight` is not installed")
  return()
endif()

get_filename_component(_lamplight_root "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(LAMPLIGHT_INCLUDE_DIR "${_lamplight_root}/include")

function(lamplight_add_bundle name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "EMBED" "MANIFEST;PROGRAM;LANGUAGE" "TARGETS")
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_MANIFEST)
    message(FATAL_ERROR "lamplight_add_bundle(NAME MANIFEST FILE [PROGRAM NAME] [TARGETS T...] "
                        "[LANGUAGE c|cpp] [EMBED])")
  endif()
  get_filename_component(manifest "${ARG_MANIFEST}" ABSOLUTE)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${name}")
  set(bundle "${folder}/${name}.lamplight")
  file(MAKE_DIRECTORY "${folder}")
  set(gen gen --manifest "${manifest}" -o "${bundle}" --depfile "${folder}/${name}.d" --force)
  if(ARG_PROGRAM)
    list(APPEND gen --program "${ARG_PROGRAM}")
  endif()
  if(ARG_TARGETS)
    list(JOIN ARG_TARGETS "," targets)
    list(APPEND gen --target "${targets}")
  endif()
  if(NOT ARG_LANGUAGE)
    set(ARG_LANGUAGE c)
  endif()
  set(bindings bindings "${bundle}" --lang "${ARG_LANGUAGE}" -o "${folder}/${name}.h")
  if(ARG_EMBED)
    list(APPEND bindings --embed)
  endif()
  # A bundle that did not change keeps its time, so it is touched.
  add_custom_command(
    OUTPUT "${bundle}"
    COMMAND "${LAMPLIGHT_PROGRAM}" ${gen}
    COMMAND "${CMAKE_COMMAND}" -E touch "${bundle}"
    DEPENDS "${manifest}"
    DEPFILE "${folder}/${name}.d"
    COMMENT "Compiling the shaders of ${ARG_MANIFEST}"
    VERBATIM)
  add_custom_command(
    OUTPUT "${folder}/${name}.h" "${folder}/${name}_keys.h"
    COMMAND "${LAMPLIGHT_PROGRAM}" ${bindings}
    COMMAND "${LAMPLIGHT_PROGRAM}" keys --manifest "${manifest}" --lang c
            -o "${folder}/${name}_keys.h"
    COMMAND "${CMAKE_COMMAND}" -E touch "${folder}/${name}.h" "${folder}/${name}_keys.h"
    DEPENDS "${bundle}"
    VERBATIM)
  add_custom_target(${name}_bundle
                    DEPENDS "${bundle}" "${folder}/${name}.h" "${folder}/${name}_keys.h")
  add_library(${name} INTERFACE)
  add_dependencies(${name} ${name}_bundle)
  target_include_directories(${name} INTERFACE "${folder}" "${LAMPLIGHT_INCLUDE_DIR}")
endfunction()

# A system of zig.sh's. WADI_ZIG_TOOLS: its folder; WADI_ZIG_TARGET: the target; CMAKE_FIND_ROOT_PATH: header libraries (header_libraries.sh).
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES WADI_ZIG_TOOLS WADI_ZIG_TARGET)
string(REGEX MATCH "^([a-z0-9_]+)-([a-z]+)" parts "${WADI_ZIG_TARGET}")
set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_MATCH_1})
set(system_of_linux Linux)
set(system_of_macos Darwin)
set(system_of_windows Windows)
set(CMAKE_SYSTEM_NAME ${system_of_${CMAKE_MATCH_2}})
if(CMAKE_SYSTEM_NAME STREQUAL "Darwin" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CMAKE_SYSTEM_PROCESSOR arm64) # as it is called there
endif()
set(CMAKE_C_COMPILER ${WADI_ZIG_TOOLS}/${WADI_ZIG_TARGET}/cc)
set(CMAKE_CXX_COMPILER ${WADI_ZIG_TOOLS}/${WADI_ZIG_TARGET}/c++)
set(CMAKE_AR ${WADI_ZIG_TOOLS}/${WADI_ZIG_TARGET}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${WADI_ZIG_TOOLS}/${WADI_ZIG_TARGET}/ranlib CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s) # names that are not exported are half a megabyte
if(CMAKE_SYSTEM_NAME STREQUAL "Linux") # zig's libraries do not end their own objects when a host closes them: that would come later, without them
  string(APPEND CMAKE_SHARED_LINKER_FLAGS_INIT " -Wl,-z,nodelete")
endif()

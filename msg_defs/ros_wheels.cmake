# Lets CMake find a ROS 2 that was installed from Python wheels. It is included right after
# project(), by -DCMAKE_PROJECT_INCLUDE=ros_wheels.cmake; CMakeLists.txt knows nothing of it.
# Where ROS is installed in another way it does nothing.

# The same Python as ament_cmake will find.
set(Python3_FIND_UNVERSIONED_NAMES FIRST)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# pip's notes about the wheel, not the module: a sourced ROS installation has the module too.
execute_process(
  COMMAND ${Python3_EXECUTABLE} -c
    "import importlib.metadata as m; print(m.distribution('ros-ament-cmake').locate_file('../../..').resolve())"
  OUTPUT_VARIABLE ros_wheels_prefix
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET
)
if(NOT ros_wheels_prefix)
  return()
endif()
message(STATUS "ROS 2 from the wheels in ${ros_wheels_prefix}")

# For find_package ...
list(APPEND CMAKE_PREFIX_PATH "${ros_wheels_prefix}")
# ... and for the ament index, in which the generators are registered.
string(FIND ":$ENV{AMENT_PREFIX_PATH}:" ":${ros_wheels_prefix}:" ros_wheels_position)
if("$ENV{AMENT_PREFIX_PATH}" STREQUAL "")
  set(ENV{AMENT_PREFIX_PATH} "${ros_wheels_prefix}")
elseif(ros_wheels_position EQUAL -1)
  set(ENV{AMENT_PREFIX_PATH} "$ENV{AMENT_PREFIX_PATH}:${ros_wheels_prefix}")
endif()

# The wheels' targets name the Python headers of the machine that built them (/opt/python/...),
# and CMake rejects a target whose include directory does not exist. The headers that are used
# come from find_package(Python3).
function(ros_wheels_drop_foreign_includes)
  get_property(targets DIRECTORY PROPERTY IMPORTED_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(includes ${target} INTERFACE_INCLUDE_DIRECTORIES)
    if(includes)
      list(FILTER includes EXCLUDE REGEX "^/opt/python/")
      set_property(TARGET ${target} PROPERTY INTERFACE_INCLUDE_DIRECTORIES "${includes}")
    endif()
  endforeach()
endfunction()
cmake_language(DEFER CALL ros_wheels_drop_foreign_includes)

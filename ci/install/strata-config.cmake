# find_package(strata): strata::strata reads a scene and runs it. Of other libraries it needs those below to be linked.
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(muparser)
find_dependency(tomlplusplus)
find_dependency(OpenMP COMPONENTS CXX)
include(${CMAKE_CURRENT_LIST_DIR}/strata-targets.cmake)

# limn_ecs for other projects: find_package(limn_ecs) gives the target limn::ecs, with the headers as
# #include "ecs/world.h". Only the ECS is installed; those of ecs/base with GLM are the engine's.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(limn::ecs ALIAS limn_ecs)
target_compile_features(limn_ecs PUBLIC cxx_std_20)
target_include_directories(limn_ecs INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/limn>)
set_target_properties(limn_ecs PROPERTIES EXPORT_NAME ecs)

if(LIMN_SANITIZE)  # who uses such a library is checked like it
    target_compile_definitions(limn_ecs INTERFACE $<INSTALL_INTERFACE:LIMN_SANITIZED=1>)
    target_compile_options(limn_ecs INTERFACE $<INSTALL_INTERFACE:-fsanitize=${LIMN_SANITIZE}>)
    target_link_options(limn_ecs INTERFACE $<INSTALL_INTERFACE:-fsanitize=${LIMN_SANITIZE}>)
endif()

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/limn_ecs)
install(TARGETS limn_ecs EXPORT limn_ecs-targets)
install(EXPORT limn_ecs-targets NAMESPACE limn:: DESTINATION ${package})
file(
    WRITE ${PROJECT_BINARY_DIR}/limn_ecs-config.cmake
    [[
include(CMakeFindDependencyMacro)
find_dependency(TBB)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/limn_ecs-targets.cmake)
]])
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limn_ecs-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limn_ecs-config.cmake ${PROJECT_BINARY_DIR}/limn_ecs-config-version.cmake
        DESTINATION ${package})
install(
    DIRECTORY ecs
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limn
    FILES_MATCHING
    PATTERN *.h
    PATTERN components EXCLUDE
    PATTERN base/air.h EXCLUDE
    PATTERN base/bezier.h EXCLUDE
    PATTERN base/gradient_noise.h EXCLUDE
    PATTERN base/math.h EXCLUDE
    PATTERN base/caustic_optics.h EXCLUDE
    PATTERN base/optics.h EXCLUDE
    PATTERN base/repeatable_math.h EXCLUDE
    PATTERN base/rng.h EXCLUDE
    PATTERN base/rotation.h EXCLUDE)

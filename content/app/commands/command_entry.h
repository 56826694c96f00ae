#pragma once

#include "ecs/base/result.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace limn {

/// A command of the program, and the function that runs it once its options are parsed.
struct Command {
    CLI::App* app = nullptr;
    std::function<Status()> run;
};

/// Help for a SCENE.
inline constexpr const char* kSceneDoc = "level name, .level.json, .gltf, .glb, .obj or .bvh";

}  // namespace limn

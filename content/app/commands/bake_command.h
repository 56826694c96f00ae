#pragma once

#include "content/app/commands/command_values.h"
#include "ecs/base/result.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

// Shown by `limn bake photometric shots.json -o face.png`: bump.normal-encoding,
//     face.photometric-normals

/// `limn bake`: makes maps from a mesh, from heights or from photographs, and clips from motion.
struct BakeOptions {
    std::string kind;
    std::string in;      ///< a mesh or heights; .json for photometric and strain_model
    std::string high;    ///< detail: the mesh with the details
    std::string out;     ///< NAME.png or NAME.exr; kinds append to NAME; a motion: .glb or .bvh
    std::string recipe;  ///< JSON file of settings; empty = defaults of the kind
    std::string mesh;    ///< name of a mesh; empty = the largest or all
    std::string body;    ///< motion and retarget: a file with a skeleton
    bool gpu = false;    ///< compute the same maps on the GPU
    std::vector<Assignment> assignments;  ///< FIELD=VALUE of the recipe
};

/// A kind of maps, or of motion.
struct BakeKind {
    const char* name;
    const char* doc;  ///< one line
    Status (*run)(const BakeOptions& options);
    const char* endings = ".png or .exr";  ///< of the file that it writes, each of 4 letters
    bool has_body = false;                 ///< takes a second file
};

/// All kinds, by name.
[[nodiscard]] std::span<const BakeKind> bake_kinds();

/// `kind` must be one of bake_kinds(). Fails with one line.
[[nodiscard]] Status run_bake(const BakeOptions& options);

}  // namespace limn

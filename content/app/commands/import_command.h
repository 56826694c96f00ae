#pragma once

#include "content/app/commands/command_values.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

// Shown by `limn import markers take.trc -o take.glb`: face.head-stabilise, face.mocap-drive
// Shown by `limn import markers take.trc --onto face.glb -o acted.glb`: face.retarget-fit,
//     face.retarget-warp
// Shown by `limn import markers take.trc -o take.glb --library said.json --text "It is one."`:
//     face.unit-generate
// Shown by `limn import bvh walk.bvh -o walk.glb`: char.bvh-format, char.skeleton-hierarchy
// Shown by `limn import bvh walk.bvh -o walk.glb --set rate=100`: char.mocap-rate

struct ImportOptions {
    std::string kind;   ///< bvh, ict-facekit, makehuman or markers
    std::string in;     ///< folder, or the file of motion or markers
    std::string out;    ///< .glb
    bool head = false;  ///< markers are named after those of the built-in head
    std::vector<Assignment> assignments = {};  ///< FIELD=VALUE of BvhImport
    // Of markers:
    std::string onto = {};     ///< .glb of a face that performs the recording; empty: none
    std::string map = {};      ///< places of markers on that face
    bool patches = false;      ///< write the surface of the markers on that face
    std::string library = {};  ///< .json of recordings to which it is added; empty: none
    std::string text = {};     ///< what is said
    std::string sound = {};    ///< .wav; empty: the one beside the markers
    std::string labels = {};   ///< when it is said; empty: found in the sound
};

/// `limn import`: converts other formats to a .glb, written completely or not at all. Progress on a
/// terminal; then a line that sums up the file.
[[nodiscard]] Status run_import(const ImportOptions& options);

}  // namespace limn

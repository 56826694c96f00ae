#pragma once

#include "content/load/obj/obj_file.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Reads untrusted material libraries of OBJ files (.mtl): colors, the exponent of highlights,
// roughness and metalness, and the images of these. A bad value costs that value and leaves one
// line of text; one above its range counts as the largest. A missing value is as in `ObjMaterial`.
// Statements that are not read are ignored, images of them with a warning.
// After Wavefront Technologies, "MTL material format", 1995, and Exocortex' extension for
// physically based materials (Pr, Pm, map_Pr, map_Pm, norm).

/// Which value of an image is meant.
enum class ObjChannel : std::uint8_t { Default, Red, Green, Blue, Alpha, Luminance };

/// An image that a material names.
struct ObjMap {
    std::string file;                          ///< as in the library; "": none
    std::string position;                      ///< "a.mtl:7: map_Kd", for messages
    Vec2 offset = {0, 0};                      ///< -o, added to scaled texture coordinates
    Vec2 scale = {1, 1};                       ///< -s
    float strength = 1;                        ///< -bm, of relief
    bool clamp = false;                        ///< -clamp
    ObjChannel channel = ObjChannel::Default;  ///< -imfchan
};

struct ObjMaterial {
    std::string name;
    std::optional<Vec3> diffuse;     ///< Kd, linear RGB, 0 .. 1
    std::optional<Vec3> emission;    ///< Ke, linear RGB, >= 0
    float shininess = 0.0f;          ///< Ns, 0 .. 1000
    std::optional<float> opacity;    ///< d, or else 1 - Tr, 0 .. 1
    std::optional<float> roughness;  ///< Pr, perceptual, 0 .. 1
    std::optional<float> metalness;  ///< Pm, 0 .. 1
    ObjMap diffuse_map;              ///< map_Kd, sRGB
    ObjMap emission_map;             ///< map_Ke, sRGB
    ObjMap opacity_map;              ///< map_d
    ObjMap shininess_map;            ///< map_Ns, times Ns
    ObjMap roughness_map;            ///< map_Pr
    ObjMap metalness_map;            ///< map_Pm
    ObjMap relief_map;               ///< bump, map_Bump: heights, or normals as Blender writes
    ObjMap normal_map;               ///< norm
};

struct ObjLibrary {
    std::vector<ObjMaterial> materials;
    std::vector<std::string> warnings;  ///< one line per bad value or ignored image
};

/// Fails where a limit is exceeded.
[[nodiscard]] Result<ObjLibrary>
parse_obj_materials(std::string_view text, const std::string& file, const ObjLimits& limits = {});

}  // namespace limn

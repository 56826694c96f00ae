#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>

namespace limn {

// A box that is empty but for the relief in it: an object drawn from maps of its sides instead of a
// mesh (relief.box, relief.multi-face, relief.slices).

/// The sides of a box, by the local axis that they face: +x, -x, +y, -y, +z, -z.
enum class ReliefFace : std::uint8_t { Right, Left, Top, Bottom, Front, Back };
inline constexpr int kReliefFaces = 6;

/// How the relief of a box is drawn.
enum class ReliefSlices : std::uint8_t {
    None,  ///< in one pass, which searches along the view ray
    Face,  ///< on planes that are parallel to the map
    View,  ///< on planes that face the camera, where layers are less visible
};

// Techniques: relief.box

/// A relief in a box about the entity's origin. Each side has a material whose relief map is the
/// object as seen through that side, depths relative to the box; sides without one show the relief
/// of `front`. Maps are as large as their side, whatever their tiling; with `detail` double_depth
/// they have a back, too, else the object reaches to the other end of the box. Where a ray leaves
/// the box without a hit, what is behind it is visible. Nothing is drawn for a camera in the box.
///
/// Shadow casters are always searched along rays; slices need no search in the shader.
struct ReliefBox {
    Vec3 size = {1, 1, 1};
    MaterialId front = {};
    MaterialId back = {};
    MaterialId left = {};
    MaterialId right = {};
    MaterialId top = {};
    MaterialId bottom = {};
    bool hide_bottom = false;
    ReliefSlices slices = ReliefSlices::None;
    int min_slices = 8;
    int max_slices = 256;
    float slice_pixels = 1.0f;
};

LIMN_FIELDS(ReliefBox) {
    LIMN_FIELD(size, "along the local x, y and z", "m", 1e-4, 1e5);
    LIMN_FIELD(front, "a material with a relief_texture: the side that faces +z");
    LIMN_FIELD(back, "the side that faces -z; none: the relief of front, from behind");
    LIMN_FIELD(left, "the side that faces -x; none: the relief of front");
    LIMN_FIELD(right, "the side that faces +x; none: the relief of front");
    LIMN_FIELD(top, "the side that faces +y; none: the relief of front");
    LIMN_FIELD(bottom, "the side that faces -y; none: the relief of front");
    LIMN_FIELD(hide_bottom, "nothing is seen through the bottom: for what stands on a floor");
    LIMN_FIELD(
        slices,
        .doc = "none: searched along the view ray; else drawn on planes parallel to the map (face) "
               "or to the image (view)",
        .values = "none face view");
    LIMN_FIELD(min_slices, "planes of a distant box", "", 1, 1024);
    LIMN_FIELD(max_slices, "planes of a near box", "", 1, 1024);
    LIMN_FIELD(
        slice_pixels,
        "distance of planes in an image of rendering.level_rows, 1080; their number is the next "
        "power of two",
        "px", 0.01, 1000);
}

/// A mesh in a box of size 1 about the origin: the box's size is a scale of its matrix. The first
/// texture coordinates are those of the map; the second hold the depth and, of slices, 1 where they
/// show only what is seen through their own side.
struct ReliefBoxPart {
    MeshId mesh = {};
    MaterialId material = {};
    std::uint64_t made_of = 0;  ///< hash of what determines the mesh
};

/// Internal state of update_relief_boxes.
struct ReliefBoxState {
    std::array<ReliefBoxPart, kReliefFaces> searched = {};  ///< by the side whose map they show
    std::array<ReliefBoxPart, kReliefFaces> sliced = {};
    std::uint32_t faces = 0;   ///< bit per ReliefFace: sides that face the camera
    int slice_count = 0;       ///< planes of each map; 0: none
    float set_back = 0;        ///< of shadow casters, since slices lie deeper than the surface [m]
    std::uint32_t unused = 0;  ///< no gap in the bytes of a value
    std::uint64_t material_version = 0;  ///< Assets::material_version of the copies
};

/// Derived from the box and the camera.
template <>
struct ComponentTraits<ReliefBoxState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

// Materials of the parts are copies whose `detail` is one of these, which levels cannot name.
inline constexpr auto kReliefBoxDetail = static_cast<SurfaceDetail>(64);
inline constexpr auto kClosedReliefBoxDetail = static_cast<SurfaceDetail>(65);
inline constexpr auto kReliefSlicesDetail = static_cast<SurfaceDetail>(66);
inline constexpr auto kClosedReliefSlicesDetail = static_cast<SurfaceDetail>(67);

}  // namespace limn

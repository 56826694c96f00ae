#pragma once

#include "content/app/player/pick.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/furrows.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <optional>
#include <string>

namespace limn {

struct FurrowPreset;
struct Material;
struct MeshData;

// What the editor of furrows does (wrinkle.furrow.editor; Bando 2001, section 5.1), without a
// window: picking vertices and tips of vectors, dragging tips, the steps from arrows to skin, skin
// materials, files. Positions are in the space of the mesh at rest unless they are in pixels, which
// count from the top left of the image.

inline constexpr float kFurrowPickRadius = 6;    ///< [px]
inline constexpr float kMaxFurrowMagnitude = 2;  ///< of a vector

// ---- picking ----

/// A mesh and the camera that views it.
struct ViewedMesh {
    const MeshData* mesh = nullptr;
    Mat4 clip_from_mesh{1.0f};  ///< without jitter
    Vec3 eye = {0, 0, 0};       ///< camera position
    Vec2 size = {1, 1};         ///< of the image [px]
};

/// Image position of a point [px]; none behind the camera.
[[nodiscard]] std::optional<Vec2> pixel_of(const ViewedMesh& viewed, const Vec3& point);

/// The ray through a pixel.
[[nodiscard]] Ray ray_of(const ViewedMesh& viewed, const Vec2& pixel);

/// The vertex nearest to the pointer in the image, within `pick_radius` pixels, among those whose
/// normal faces the camera and that no triangle occludes. Among equally near ones, the first.
[[nodiscard]] std::optional<std::uint32_t> pick_furrow_vertex(
    const ViewedMesh& viewed, const Vec2& pointer, float pick_radius = kFurrowPickRadius);

/// Which of the two vectors drawn at `position` with this `length` per magnitude has its tip
/// nearest to the pointer, within `pick_radius` pixels.
[[nodiscard]] std::optional<int> pick_furrow_tip(
    const ViewedMesh& viewed, const Vec3& position, const FurrowVectors& vectors, float length,
    const Vec2& pointer, float pick_radius = kFurrowPickRadius);

/// The vector whose tip is where `ray` intersects the plane through `position` with unit `normal`,
/// of a magnitude of at most 2. Where they are nearly parallel, the point of the
/// plane below the point of the ray that is nearest to `position`.
[[nodiscard]] Vec3
drag_furrow_tip(const Vec3& position, const Vec3& normal, float length, const Ray& ray);

// ---- arrows ----

/// The arrow at the position of `vertex`, which other vertices may share; among several, the last.
[[nodiscard]] std::optional<std::size_t>
find_furrow_arrow(const FurrowSkin& skin, const MeshData& mesh, std::uint32_t vertex);

/// The arrow at `vertex`; if there is none, adds one with the skin's current vectors there.
FurrowArrow& edit_furrow_vertex(
    Furrows& furrows, const FurrowSkin& skin, const MeshData& mesh, std::uint32_t vertex);

// ---- steps ----

/// INITIALIZE: no arrows; both fields are those of an unedited mesh.
void initialize_furrows(Furrows& furrows);
/// Whether edits wait for the steps below, or take effect at once.
void let_furrows_wait(Furrows& furrows, bool wait);
/// INTERPOLATE: vertices without an arrow follow those with one.
void interpolate_furrows(Furrows& furrows);
/// GENERATE: furrows grow along the last interpolated fields.
void generate_furrows(Furrows& furrows);
/// REMAKE: noise and bump on the existing furrows.
void remake_furrows(Furrows& furrows);

// ---- skin ----

/// The reflection model of the skin.
enum class FurrowReflection : std::uint8_t {
    Own,    ///< Blinn's model with the parameters of FurrowLook (skin.blinn, skin.melanin-blood)
    Brdf1,  ///< BRDF1: stand-ins for the measured lobes, which were not published
    Brdf2,  ///< BRDF2
};

/// Section "skin material" of the editor.
struct FurrowLook {
    FurrowReflection reflection = FurrowReflection::Own;
    float melanin = 0.2f;
    float blood = 0.5f;
    float specular = 0.2f;
    float shininess = 100;
    bool operator==(const FurrowLook&) const = default;
};

LIMN_FIELDS(FurrowLook) {
    LIMN_FIELD(
        reflection, .doc = "own parameters, or one of two fitted BRDFs",
        .values = "own brdf_1 brdf_2", .renamed = "measured_1=brdf_1 measured_2=brdf_2");
    LIMN_FIELD(melanin, "amount of melanin", "", 0, 1);
    LIMN_FIELD(blood, "amount of blood", "", 0, 1);
    LIMN_FIELD(specular, "reflectance, colorless", "", 0, 1);
    LIMN_FIELD(shininess, "exponent of the highlight", "", 0, 128);
}

[[nodiscard]] FurrowLook furrow_look_of(const Material& material);
/// Keeps textures. Exponents are clamped to at least 1, the minimum of materials.
void set_furrow_look(Material& material, const FurrowLook& look);

/// The settings of a figure: noise, bump and scale of `furrows`, and the skin.
void set_furrow_preset(Furrows& furrows, FurrowLook& look, const FurrowPreset& preset);

// ---- files ----

/// All that the editor sets. As a file it is JSON with "furrows", which a level can use unchanged,
/// and "skin".
struct FurrowFile {
    Furrows furrows;  ///< without images or pending steps
    FurrowLook skin;
    bool operator==(const FurrowFile&) const = default;
};

/// Fails with the file's name and the reason.
[[nodiscard]] Status save_furrows(const std::string& path, const FurrowFile& file);
/// Fails with file, line and what was expected, and changes nothing.
[[nodiscard]] Result<FurrowFile> load_furrows(const std::string& path);

}  // namespace limn

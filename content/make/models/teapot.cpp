#include "content/make/models/teapot.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <array>

// Techniques: anim.bezier-patch-lod, bump.tangent-bezier, bump.teapot, fakephong.scenes

namespace limn {

namespace {

// ---- the data ----------------------------------------------------------------------------------

/// A profile to revolve: control points (radius, height) from bottom to top, the outside to the
/// right; and the handle factor of the quarter circle of each point. Listed from the top.
struct TurnedProfile {
    TeapotPart part;
    bool starts_chart;  ///< the texture restarts instead of continuing from the one above
    std::array<Vec2, 4> points;
    std::array<float, 4> circle = {0.56f, 0.56f, 0.56f, 0.56f};
};

constexpr TurnedProfile kProfiles[] = {
    {TeapotPart::Rim,
     true,
     {Vec2(1.5f, 2.4f), {1.4375f, 2.53125f}, {1.3375f, 2.53125f}, {1.4f, 2.4f}}},
    {TeapotPart::Body, false, {Vec2(2, 0.9f), {2, 1.35f}, {1.75f, 1.875f}, {1.5f, 2.4f}}},
    {TeapotPart::Body, false, {Vec2(1.5f, 0.15f), {1.5f, 0.225f}, {2, 0.45f}, {2, 0.9f}}},
    {TeapotPart::Bottom, false, {Vec2(0, 0), {1.425f, 0}, {1.5f, 0.075f}, {1.5f, 0.15f}}},
    {TeapotPart::Lid,
     true,
     {Vec2(0.2f, 2.7f), {0, 2.85f}, {0.8f, 3.15f}, {0, 3.15f}},
     {0.56f, 0.56f, 0.5625f, 0.56f}},
    {TeapotPart::Lid, false, {Vec2(1.3f, 2.4f), {1.3f, 2.55f}, {0.4f, 2.55f}, {0.2f, 2.7f}}}};

/// The half of a duct at z >= 0: four cross sections along its length, each from the outer side of
/// the bend over the flank to the inner side.
struct Duct {
    TeapotPart part;
    bool starts_chart;
    std::array<std::array<Vec3, 4>, 4> sections;
};

constexpr Duct kDucts[] = {
    {TeapotPart::Handle,
     true,
     {{{Vec3(-1.5f, 2.25f, 0), {-1.5f, 2.25f, 0.3f}, {-1.6f, 2.025f, 0.3f}, {-1.6f, 2.025f, 0}},
       {Vec3(-2.5f, 2.25f, 0), {-2.5f, 2.25f, 0.3f}, {-2.3f, 2.025f, 0.3f}, {-2.3f, 2.025f, 0}},
       {Vec3(-3, 2.25f, 0), {-3, 2.25f, 0.3f}, {-2.7f, 2.025f, 0.3f}, {-2.7f, 2.025f, 0}},
       {Vec3(-3, 1.8f, 0), {-3, 1.8f, 0.3f}, {-2.7f, 1.8f, 0.3f}, {-2.7f, 1.8f, 0}}}}},
    {TeapotPart::Handle,
     false,
     {{{Vec3(-3, 1.8f, 0), {-3, 1.8f, 0.3f}, {-2.7f, 1.8f, 0.3f}, {-2.7f, 1.8f, 0}},
       {Vec3(-3, 1.35f, 0), {-3, 1.35f, 0.3f}, {-2.7f, 1.575f, 0.3f}, {-2.7f, 1.575f, 0}},
       {Vec3(-2.65f, 0.9375f, 0),
        {-2.65f, 0.9375f, 0.3f},
        {-2.5f, 1.125f, 0.3f},
        {-2.5f, 1.125f, 0}},
       {Vec3(-1.9f, 0.6f, 0), {-1.9f, 0.6f, 0.3f}, {-2, 0.9f, 0.3f}, {-2, 0.9f, 0}}}}},
    {TeapotPart::Spout,
     true,
     {{{Vec3(1.7f, 0.6f, 0), {1.7f, 0.6f, 0.66f}, {1.7f, 1.425f, 0.66f}, {1.7f, 1.425f, 0}},
       {Vec3(3.1f, 0.825f, 0), {3.1f, 0.825f, 0.66f}, {2.6f, 1.425f, 0.66f}, {2.6f, 1.425f, 0}},
       {Vec3(2.4f, 2.025f, 0), {2.4f, 2.025f, 0.25f}, {2.3f, 2.1f, 0.25f}, {2.3f, 2.1f, 0}},
       {Vec3(3.3f, 2.4f, 0), {3.3f, 2.4f, 0.25f}, {2.7f, 2.4f, 0.25f}, {2.7f, 2.4f, 0}}}}},
    {TeapotPart::Spout,
     false,
     {{{Vec3(3.3f, 2.4f, 0), {3.3f, 2.4f, 0.25f}, {2.7f, 2.4f, 0.25f}, {2.7f, 2.4f, 0}},
       {Vec3(3.525f, 2.49375f, 0),
        {3.525f, 2.49375f, 0.25f},
        {2.8f, 2.475f, 0.25f},
        {2.8f, 2.475f, 0}},
       {Vec3(3.45f, 2.5125f, 0), {3.45f, 2.5125f, 0.15f}, {2.9f, 2.475f, 0.15f}, {2.9f, 2.475f, 0}},
       {Vec3(3.2f, 2.4f, 0), {3.2f, 2.4f, 0.15f}, {2.8f, 2.4f, 0.15f}, {2.8f, 2.4f, 0}}}}}};

constexpr float kHeight = 3.15f;

// ---- texture coordinates -----------------------------------------------------------------------

/// Length of a cubic as a polyline of eight segments: accurate to a percent, enough for texturing.
template <typename T>
float curve_length(const std::array<T, 4>& curve) {
    float length = 0;
    for (int i = 0; i < 8; ++i) {
        length += glm::length(
            bezier_point(curve, static_cast<float>(i + 1) / 8.0f)
            - bezier_point(curve, static_cast<float>(i) / 8.0f));
    }
    return length;
}

/// Texture coordinate per unit length along v: about square texels where the pot is widest.
float texture_density(TeapotPart part) {
    switch (part) {
    case TeapotPart::Handle:
        return 1.0f / 1.6f;
    case TeapotPart::Spout:
        return 1.0f / 2.4f;
    default:
        return 4.0f / (2.0f * kPi * 2.0f);
    }
}

// ---- patches -----------------------------------------------------------------------------------

/// Quarter `quarter` of a revolved profile: u runs counter-clockwise when viewed from above, v up.
BezierPatch turn_profile(const TurnedProfile& profile, int quarter) {
    BezierPatch patch;
    for (std::size_t j = 0; j < 4; ++j) {
        const float radius = profile.points[j].x;
        const float height = profile.points[j].y;
        const float off = profile.circle[j] * radius;
        const Vec2 arc[4] = {{radius, 0}, {radius, off}, {off, radius}, {0, radius}};
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec2 p = arc[i];
            const Vec2 turned[4] = {{p.x, p.y}, {-p.y, p.x}, {-p.x, -p.y}, {p.y, -p.x}};
            patch.p[i][j] = {turned[quarter].x, height, -turned[quarter].y};
        }
    }
    return patch;
}

/// Half a duct as a patch; u x v points out of the duct.
BezierPatch lay_duct(const Duct& duct, bool mirrored) {
    BezierPatch patch;
    for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
            Vec3 p = duct.sections[3 - j][mirrored ? 3 - i : i];
            p.z = mirrored ? -p.z : p.z;
            patch.p[i][j] = p;
        }
    }
    return patch;
}

}  // namespace

std::vector<TeapotPatch> teapot_patches(bool bottom) {
    std::vector<TeapotPatch> patches;

    // Texture rows run downwards: a patch starts (v = 0, its lower end) where the next one ends.
    float above = 0;
    float below = 0;
    const auto next_row = [&](bool starts_chart, float length) {
        above = starts_chart ? 0.0f : below;
        below = above + length;
    };
    for (const TurnedProfile& profile : kProfiles) {
        if (profile.part == TeapotPart::Bottom && !bottom) {
            continue;
        }
        next_row(
            profile.starts_chart, curve_length(profile.points) * texture_density(profile.part));
        for (int quarter = 0; quarter < 4; ++quarter) {
            const auto u = static_cast<float>(quarter);
            patches.push_back(
                {profile.part, turn_profile(profile, quarter), {u, below}, {u + 1, above}});
        }
    }
    for (const Duct& duct : kDucts) {
        std::array<Vec3, 4> spine;
        for (std::size_t j = 0; j < 4; ++j) {
            spine[j] = 0.5f * (duct.sections[j][0] + duct.sections[j][3]);
        }
        next_row(duct.starts_chart, curve_length(spine) * texture_density(duct.part));
        for (const bool mirrored : {false, true}) {
            const float u = mirrored ? 0.5f : 0.0f;
            patches.push_back({duct.part, lay_duct(duct, mirrored), {u, below}, {u + 0.5f, above}});
        }
    }
    return patches;
}

namespace {

/// The pieces of all patches at a level of their hierarchy, each a patch.
std::vector<TeapotPatch> patches_at_level(const std::vector<TeapotPatch>& pot, int level) {
    std::vector<TeapotPatch> pieces;
    const std::size_t side = std::size_t{1} << level;
    for (const TeapotPatch& patch : pot) {
        const PatchLevels levels = make_patch_levels(patch.surface, level + 1);
        for (std::size_t i = 0; i < side * side; ++i) {
            const Vec2 at = Vec2(i % side, i / side) / static_cast<float>(side);
            const auto uv = [&](const Vec2& corner) {
                return glm::mix(patch.uv_at_start, patch.uv_at_end, corner);
            };
            pieces.push_back(
                {patch.part, levels.level.back()[i], uv(at),
                 uv(at + 1.0f / static_cast<float>(side))});
        }
    }
    return pieces;
}

}  // namespace

MeshData make_teapot(const TeapotShape& shape) {
    LIMN_CHECK(shape.height > 0 && shape.tolerance >= 0);
    const std::vector<TeapotPatch> whole = teapot_patches(shape.bottom);
    const std::vector<TeapotPatch> pot =
        shape.level >= 0 ? patches_at_level(whole, shape.level) : whole;
    const int divisions = shape.level >= 0 ? 1 : shape.divisions;
    const float scale = shape.height / kHeight;
    std::vector<BezierPatch> surfaces;
    for (const TeapotPatch& patch : pot) {
        surfaces.push_back(patch.surface);
        for (auto& row : surfaces.back().p) {
            for (Vec3& point : row) {
                point *= scale;
            }
        }
    }
    const PatchTriangles triangles = shape.tolerance > 0
                                         ? tessellate_adaptive(surfaces, shape.tolerance)
                                         : tessellate_uniform(surfaces.size(), divisions);
    MeshData mesh = make_patch_mesh(surfaces, triangles);
    for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
        const PatchSample& sample = triangles.samples[i];
        const TeapotPatch& patch = pot[sample.patch];
        mesh.uvs[i] = glm::mix(patch.uv_at_start, patch.uv_at_end, Vec2(sample.u, sample.v));
    }
    return mesh;
}

}  // namespace limn

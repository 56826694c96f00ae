#pragma once

#include "ecs/components/furrows.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/texture.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace limn {

struct MeshData;

// Furrows of entities: updates the images of their materials whenever they are regrown, and
// visualizes them on their mesh (FurrowView, wrinkle.furrow.view-modes): white faces with vertices
// and both fields, or the height of furrows. In the other modes materials show skin, and nothing
// is drawn here.
//
// Reads    FurrowSkin, FurrowView; depth of the scene, which occludes the view
// Writes   the images of Furrows; display: colors are exact
// Order    last
// Shaders  furrow_face.vert .frag, furrow_mark.vert .frag
//
// Deformed meshes are shown at rest.

/// A line with round caps, or a dot, in mesh space. Layout of furrow_mark.vert: three texels.
struct FurrowMark {
    Vec3 from = {0, 0, 0};
    float radius = 1;  ///< [px] of an image of 720 rows
    Vec3 to = {0, 0, 0};
    float spacing = 0;  ///< spacing of similar marks [m], which limits the radius; 0: no limit
    Vec4 color = {1, 1, 1, 1};  ///< display values
};
static_assert(sizeof(FurrowMark) == 48);

/// Radius of a mark in an image of this many rows [px].
[[nodiscard]] inline float furrow_mark_pixels(int rows, float radius) {
    return radius * std::max(static_cast<float>(rows) / 720.0f, 0.5f);
}

inline constexpr float kFurrowTipRadius = 3.5f;  ///< tips of vectors that can be dragged
inline constexpr Vec4 kFurrowVertexColor = {0, 0, 1, 1};
inline constexpr Vec4 kFurrowFieldColor[2] = {{1, 0, 0, 1}, {0, 1, 0, 1}};
inline constexpr Vec4 kFurrowHaloColor = {1, 0.6f, 0, 1};  ///< around the selected vertex

/// Two lines for each vertex, or each edited one, with dots at the tips of edited ones, and a dot
/// for each vertex, in drawing order.
[[nodiscard]] std::vector<FurrowMark>
furrow_marks(const MeshData& mesh, const FurrowSkin& skin, const FurrowView& view);

/// A mesh that is visualized in this frame.
struct ShownFurrows {
    FurrowMode mode = FurrowMode::Vectors;
    Affine world_from_mesh;
    int corners = 0;
    int marks = 0;
    BufferTexture vertices = BufferTexture("furrow vertices", GL_RGBA32F);
    BufferTexture indices = BufferTexture("furrow indices", GL_R32UI);
    BufferTexture mark_records = BufferTexture("furrow marks", GL_RGBA32F);
    Entity entity;
    std::uint32_t version = 0;  ///< of the heights uploaded; 0: none
    gpu::Texture heights;
};

/// A skin whose images have been uploaded.
struct UploadedFurrows {
    Entity entity;
    std::uint32_t version = 0;  ///< of the FurrowSkin
};

struct FurrowEffect {
    const gpu::Program* faces = nullptr;
    const gpu::Program* marks = nullptr;
    gpu::Sampler texels;
    std::vector<UploadedFurrows> uploaded = {};  ///< in world order
    std::vector<ShownFurrows> shown = {};

    static Result<FurrowEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn

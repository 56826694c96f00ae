#include "render/material/furrow_pass.h"

#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/material/image_pool.h"
#include "render/material/material_pool.h"
#include "render/shaders/furrow_gpu.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.view-modes

namespace limn {
namespace {

constexpr float kLineRadius = 0.75f;    // [px]
constexpr float kEditedRadius = 1.25f;  // radius of the lines of edited vertices
constexpr float kVertexRadius = 1.5f;
constexpr float kEditedVertexRadius = 3;
constexpr float kHaloRadius = 6.5f;

/// Mean length of the edges at each vertex [m]; 0 without any.
std::vector<float> vertex_spacings(const MeshData& mesh) {
    std::vector<float> sums(mesh.positions.size(), 0.0f);
    std::vector<float> counts(mesh.positions.size(), 0.0f);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.indices[i + k];
            const std::uint32_t b = mesh.indices[i + (k + 1) % 3];
            const float length = glm::distance(mesh.positions[a], mesh.positions[b]);
            for (const std::uint32_t v : {a, b}) {
                sums[v] += length;
                counts[v] += 1;
            }
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
        sums[v] /= std::max(counts[v], 1.0f);
    }
    return sums;
}

/// `spacing`: 0 for edited vertices, which are few.
void append_vectors(
    const Vec3& at, const FurrowVectors& vectors, float length, float spacing,
    std::vector<FurrowMark>& marks) {
    for (std::size_t f = 0; f < 2; ++f) {
        marks.push_back(
            {.from = at,
             .radius = spacing > 0 ? kLineRadius : kEditedRadius,
             .to = at + length * vectors[f],
             .spacing = spacing,
             .color = kFurrowFieldColor[f]});
    }
}

void append_dot(
    const Vec3& at, float radius, float spacing, const Vec4& color,
    std::vector<FurrowMark>& marks) {
    marks.push_back({.from = at, .radius = radius, .to = at, .spacing = spacing, .color = color});
}

/// Two texels per vertex: position and u; v.
std::vector<Vec4> vertex_records(const MeshData& mesh) {
    std::vector<Vec4> records;
    records.reserve(2 * mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        records.emplace_back(mesh.positions[i], mesh.uvs[i].x);
        records.emplace_back(mesh.uvs[i].y, 0, 0, 0);
    }
    return records;
}

void upload_heights(ShownFurrows& furrows, Entity entity, const FurrowSkin& skin) {
    if (furrows.entity == entity && furrows.version == skin.version && furrows.heights.id() != 0) {
        return;
    }
    furrows.entity = entity;
    furrows.version = skin.version;
    const IVec2 size = skin.growth.size;
    if (furrows.heights.id() == 0
        || IVec2(furrows.heights.width(), furrows.heights.height()) != size) {
        furrows.heights =
            gpu::Texture("furrow heights", {.format = GL_R32F, .width = size.x, .height = size.y});
    }
    furrows.heights.upload(std::as_bytes(std::span(skin.height)));
}

void upload_images(FurrowEffect& effect, const FrameData& frame) {
    if (frame.assets_replaced) {
        effect.uploaded.clear();
    }
    std::size_t count = 0;
    frame.world->query<const FurrowSkin>().each([&](Entity entity, const FurrowSkin& skin) {
        if (count == effect.uploaded.size()) {
            effect.uploaded.emplace_back();
        }
        UploadedFurrows& uploaded = effect.uploaded[count++];
        if (!skin.fault.empty()
            || (uploaded.entity == entity && uploaded.version == skin.version)) {
            return;
        }
        uploaded = {entity, skin.version};
        ImagePool& images = frame.materials->images();
        images.replace(skin.source.normals, skin.normals);
        images.replace(skin.source.heights, skin.heights);
    });
    effect.uploaded.resize(count);
}

void show_meshes(FurrowEffect& effect, FrameData& frame) {
    const auto* const jumps = frame.world->find_resource<StepJumps>();
    std::size_t count = 0;
    frame.world
        ->query<
            const FurrowView, const FurrowSkin, const MeshInstance, const WorldTransform,
            Optional<const PreviousWorldTransform>>()
        .each([&](Entity entity, const FurrowView& view, const FurrowSkin& skin,
                  const MeshInstance& instance, const WorldTransform& now,
                  const PreviousWorldTransform* before) {
            const bool drawn = view.mode == FurrowMode::Vectors || view.mode == FurrowMode::Height;
            if (!drawn || !skin.fault.empty() || instance.mesh.index >= frame.assets->meshes.size()
                || skin.mesh != instance.mesh) {
                return;
            }
            const MeshData& mesh = frame.assets->meshes[instance.mesh.index];
            if (mesh.version != skin.mesh_version) {
                return;
            }
            if (count == effect.shown.size()) {
                effect.shown.emplace_back();
            }
            ShownFurrows& furrows = effect.shown[count++];
            furrows.mode = view.mode;
            const float alpha = frame.camera.alpha;
            furrows.world_from_mesh = world_at(jumps, entity, now, before, {alpha, alpha});
            furrows.corners = static_cast<int>(mesh.indices.size());
            furrows.vertices.upload(*frame.ring, vertex_records(mesh));
            furrows.indices.upload(*frame.ring, mesh.indices);
            furrows.marks = 0;
            if (view.mode == FurrowMode::Vectors) {
                const std::vector<FurrowMark> found = furrow_marks(mesh, skin, view);
                furrows.marks = static_cast<int>(found.size());
                furrows.mark_records.upload(*frame.ring, found);
            }
            upload_heights(furrows, entity, skin);
        });
    effect.shown.erase(
        effect.shown.begin() + static_cast<std::ptrdiff_t>(count), effect.shown.end());
}

}  // namespace

std::vector<FurrowMark>
furrow_marks(const MeshData& mesh, const FurrowSkin& skin, const FurrowView& view) {
    std::vector<FurrowMark> marks;
    const std::size_t vertices = std::min(mesh.positions.size(), skin.field.size());
    const float length = furrow_vector_length(view, skin);
    const std::vector<float> spacings = vertex_spacings(mesh);
    std::vector<bool> edited(vertices, false);
    for (const std::uint32_t vertex : skin.edited) {
        if (vertex < vertices) {
            edited[vertex] = true;
        }
    }
    for (const bool now : {false, true}) {
        for (std::size_t v = 0; v < vertices; ++v) {
            if (edited[v] == now && (now || !view.only_edited)) {
                append_vectors(
                    mesh.positions[v], skin.field[v], length, now ? 0 : spacings[v], marks);
            }
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t f = 0; f < 2 && edited[v]; ++f) {
            append_dot(
                mesh.positions[v] + length * skin.field[v][f], kFurrowTipRadius, 0,
                kFurrowFieldColor[f], marks);
        }
    }
    if (view.selected >= 0 && static_cast<std::size_t>(view.selected) < vertices) {
        append_dot(
            mesh.positions[static_cast<std::size_t>(view.selected)], kHaloRadius, 0,
            kFurrowHaloColor, marks);
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        append_dot(
            mesh.positions[v], edited[v] ? kEditedVertexRadius : kVertexRadius,
            edited[v] ? 0 : spacings[v], kFurrowVertexColor, marks);
    }
    return marks;
}

Result<FurrowEffect> FurrowEffect::create(gpu::Device& device, const RenderSettings&) {
    return FurrowEffect{
        LIMN_TRY(
            device.shaders().load({.vertex = "furrow_face.vert", .fragment = "furrow_face.frag"})),
        LIMN_TRY(
            device.shaders().load({.vertex = "furrow_mark.vert", .fragment = "furrow_mark.frag"})),
        gpu::Sampler("furrow heights", {.minify = GL_LINEAR, .magnify = GL_LINEAR})};
}

bool FurrowEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const FurrowSkin>().empty();
}

void FurrowEffect::collect(FrameData& frame) {
    upload_images(*this, frame);
    show_meshes(*this, frame);
}

void FurrowEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (shown.empty() || !view.is(kFilmViews)) {
        return;
    }
    const TextureId depth =
        create_target(graph, "furrow view depth", GL_DEPTH_COMPONENT32F, view.size());
    const TextureId scene = view.gbuffer.depth;
    const auto add = [&](auto draw_shown, Use to_depth) {
        const auto run = [this, &view, scene, draw_shown](PassContext& context) {
            for (const ShownFurrows& furrows : shown) {
                const Mat4 clip_from_mesh =
                    view.camera.unjittered_from_world * to_mat4(furrows.world_from_mesh);
                const auto set = [&](const gpu::Program& to) {
                    to.set("clip_from_mesh", clip_from_mesh);
                    to.set("has_scene", scene.valid() ? 1 : 0);
                };
                if (scene.valid()) {
                    context.bind_texture(layout::kFurrowSceneUnit, scene);
                }
                draw_shown(context, furrows, set);
            }
        };
        if (scene.valid()) {
            graph.add_pass("furrow view", {scene}, {view.display, to_depth}, run);
        } else {
            graph.add_pass("furrow view", {}, {view.display, to_depth}, run);
        }
    };
    add(
        [this, &view](PassContext& context, const ShownFurrows& furrows, const auto& set) {
            context.device().use(gpu::Pipeline{faces, {.cull = GL_NONE}});
            set(*faces);
            const Vec3 eye = transform_point(view.camera.world_from_camera, {0, 0, 0});
            const Mat4 mesh_from_world = glm::inverse(to_mat4(furrows.world_from_mesh));
            faces->set("eye", Vec3(mesh_from_world * Vec4(eye, 1)));
            faces->set("shows_height", furrows.mode == FurrowMode::Height ? 1 : 0);
            furrows.vertices.bind(context.device(), layout::kFurrowVerticesUnit);
            furrows.indices.bind(context.device(), layout::kFurrowIndicesUnit);
            context.device().bind_texture(layout::kFurrowHeightsUnit, furrows.heights, &texels);
            context.device().draw_ids(furrows.corners);
        },
        cleared(depth));
    add(
        [this](PassContext& context, const ShownFurrows& furrows, const auto& set) {
            if (furrows.marks == 0) {
                return;
            }
            context.device().use(gpu::Pipeline{
                marks,
                {.depth = {.write = false}, .blend = gpu::kBlendPremultiplied, .cull = GL_NONE}});
            set(*marks);
            const IVec2 size = context.size();
            marks->set("size", Vec2(size));
            marks->set("pixels", furrow_mark_pixels(size.y, 1));
            furrows.mark_records.bind(context.device(), layout::kFurrowMarksUnit);
            context.device().draw_ids(6 * furrows.marks);
        },
        depth);
}

}  // namespace limn

#include "render/light/mirror_caustic_pass.h"

#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/light_list.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: caustic.reflection-plane

namespace limn {
namespace {

bool is_finite_mirror(const MirrorCaustic& m) {
    const float sum = m.normal.x + m.normal.y + m.normal.z + m.offset + m.color.x + m.color.y
                      + m.color.z + m.strength + m.plane_exponent + m.surface_exponent
                      + m.max_distance + m.max_height + m.wires;
    return std::isfinite(sum) && glm::length(m.normal) > 1e-6f;
}

void draw_mirror(
    gpu::Device& device, const gpu::Program& program, const ViewData& view,
    const CausticMirror& mirror, bool wires) {
    const std::vector<MeshRange>& meshes = view.frame->meshes->meshes();
    if (mirror.mesh >= meshes.size()) {
        return;
    }
    const MeshRange& mesh = meshes[mirror.mesh];
    const MirrorCaustic& m = mirror.settings;
    const auto& lights = view.data.get<LightList>();
    const layout::LightRecord& light = lights.records.front();
    const float length = glm::length(m.normal);
    program.set("row_x", mirror.world_from_mesh.row[0]);
    program.set("row_y", mirror.world_from_mesh.row[1]);
    program.set("row_z", mirror.world_from_mesh.row[2]);
    program.set("light", Vec4(Vec3(light.position), lights.directional > 0 ? 0.0f : 1.0f));
    program.set("plane", Vec4(m.normal, m.offset) / length);
    program.set("look", Vec4(m.plane_exponent, m.surface_exponent, m.max_distance, m.max_height));
    program.set("color", wires ? Vec3(m.wires) : m.strength * m.color * Vec3(light.color));
    program.set("even", wires ? 1.0f : 0.0f);
    device.draw_indexed(
        GL_TRIANGLES, static_cast<int>(mesh.index_count), index_type(mesh.wide),
        mesh.first_index * index_size(mesh.wide), mesh.base_vertex);
}

}  // namespace

Result<MirrorCausticEffect>
MirrorCausticEffect::create(gpu::Device& device, const RenderSettings&) {
    return MirrorCausticEffect{LIMN_TRY(device.shaders().load(
        {.vertex = "mirror_caustic.vert", .fragment = "mirror_caustic.frag"}))};
}

bool MirrorCausticEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const MirrorCaustic>().empty();
}

void MirrorCausticEffect::collect(FrameData& frame) {
    mirrors.clear();
    const auto* const jumps = frame.world->find_resource<StepJumps>();
    frame.world
        ->query<
            const MirrorCaustic, const MeshInstance, const WorldTransform,
            Optional<const PreviousWorldTransform>>()
        .each([&](Entity entity, const MirrorCaustic& settings, const MeshInstance& surface,
                  const WorldTransform& now, const PreviousWorldTransform* before) {
            if (is_finite_mirror(settings) && settings.strength > 0) {
                const float alpha = frame.camera.alpha;
                const Affine pose = world_at(jumps, entity, now, before, {alpha, alpha});
                mirrors.push_back({settings, surface.mesh.index, pose});
            }
        });
}

void MirrorCausticEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (mirrors.empty() || view.data.get<LightList>().records.empty()) {
        return;
    }
    graph.add_pass(
        "mirror caustics", {depth_tested(view.gbuffer.depth)}, {view.radiance},
        [this, &view](PassContext& context) {
            bind_view(context, view);
            context.device().bind_vertex_array(view.frame->meshes->streams().vertices());
            const bool any_wires = std::ranges::any_of(
                mirrors, [](const CausticMirror& mirror) { return mirror.settings.wires > 0; });
            for (const bool wires : {false, true}) {
                if (wires && !any_wires) {
                    break;
                }
                context.device().use(gpu::Pipeline{
                    program,
                    {.depth = {.write = false},
                     .blend = gpu::kBlendAdd,
                     .cull = GL_NONE,
                     .wireframe = wires}});
                for (const CausticMirror& mirror : mirrors) {
                    if (!wires || mirror.settings.wires > 0) {
                        draw_mirror(context.device(), *program, view, mirror, wires);
                    }
                }
            }
        });
}

}  // namespace limn

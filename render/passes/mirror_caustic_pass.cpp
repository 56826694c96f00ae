#include "render/passes/mirror_caustic_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/render_view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

bool is_finite(const MirrorCaustic& m) {
    const float sum = m.normal.x + m.normal.y + m.normal.z + m.offset + m.color.x + m.color.y
                      + m.color.z + m.strength + m.power_plane + m.power_surface + m.farthest
                      + m.highest;
    return std::isfinite(sum) && glm::length(m.normal) > 1e-6f;
}

void draw_mirror(
    gpu::Device& device, const gpu::Program& program, const FrameScene& scene,
    const CausticMirror& mirror) {
    if (mirror.mesh >= scene.meshes->meshes().size()) {
        return;
    }
    const MeshRange& mesh = scene.meshes->meshes()[mirror.mesh];
    const MirrorCaustic& m = mirror.settings;
    const layout::LightRecord& light = scene.lights.records.front();
    const float length = glm::length(m.normal);
    program.set("row_x", mirror.world_from_mesh.row[0]);
    program.set("row_y", mirror.world_from_mesh.row[1]);
    program.set("row_z", mirror.world_from_mesh.row[2]);
    program.set("light", Vec4(Vec3(light.position), scene.lights.directional > 0 ? 0.0f : 1.0f));
    program.set("plane", Vec4(m.normal, m.offset) / length);
    program.set("look", Vec4(m.power_plane, m.power_surface, m.farthest, m.highest));
    program.set("color", m.strength * m.color * Vec3(light.color));
    device.draw_indexed(
        GL_TRIANGLES, static_cast<int>(mesh.index_count), GL_UNSIGNED_INT,
        mesh.first_index * sizeof(std::uint32_t), mesh.base_vertex);
}

}  // namespace

void collect_mirrors(const World& world, float alpha, std::vector<CausticMirror>& mirrors) {
    mirrors.clear();
    world
        .query<
            const MirrorCaustic, const MeshInstance, const WorldTransform,
            Optional<const PreviousWorldTransform>>()
        .each([&](const MirrorCaustic& settings, const MeshInstance& surface,
                  const WorldTransform& now, const PreviousWorldTransform* before) {
            if (is_finite(settings) && settings.strength > 0) {
                const Affine place =
                    before != nullptr ? mix_affine(before->world, now.world, alpha) : now.world;
                mirrors.push_back({settings, surface.mesh.index, place});
            }
        });
}

void draw_mirror_caustics(
    FrameGraph& graph, gpu::Device& device, MirrorCausticPass& pass, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer) {
    if (pass.mirrors.empty() || scene.lights.records.empty()) {
        return;
    }
    if (pass.program == nullptr && !pass.failed) {
        const Result<const gpu::Program*> made = device.shaders().load(
            {.vertex = "mirror_caustic.vert", .fragment = "mirror_caustic.frag"});
        pass.failed = !made;
        if (made) {
            pass.program = *made;
        } else {
            log_error("{}", made.error().message);
        }
    }
    if (pass.program == nullptr) {
        return;
    }
    graph.add_pass(
        "mirror caustics", {depth_tested(gbuffer.depth)}, {radiance},
        [&pass, &scene](PassContext& context) {
            gpu::Device& its_device = context.device();
            its_device.use(gpu::Pipeline{
                pass.program,
                {.depth = {.write = false}, .blend = gpu::kBlendAdd, .cull = GL_NONE}});
            bind_view(its_device, scene);
            its_device.bind_vertex_array(scene.meshes->vertices());
            for (const CausticMirror& mirror : pass.mirrors) {
                draw_mirror(its_device, *pass.program, scene, mirror);
            }
        });
}

}  // namespace limn

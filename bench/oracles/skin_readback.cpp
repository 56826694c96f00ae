#include "bench/oracles/skin_readback.h"

#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/ring_buffer.h"
#include "render/graph/frame_graph.h"
#include "render/material/wrinkle_hook.h"
#include "render/material/wrinkle_pass.h"
#include "render/render_frame.h"
#include "render/skinning/deform_pass.h"
#include "render/skinning/deformed_list.h"

#include <glm/gtc/packing.hpp>

namespace limn::oracle {
namespace {

float from_snorm(std::int16_t x) {
    return static_cast<float>(x) / 32767.0f;
}

template <typename T>
std::vector<T> read(const gpu::Buffer& buffer, std::size_t first, std::size_t count) {
    std::vector<T> values(count);
    buffer.read(first * sizeof(T), std::as_writable_bytes(std::span(values)));
    return values;
}

}  // namespace

struct SkinReadback::Machine {
    Machine(
        gpu::Device& device, DeformPass made, WrinkleEffect wrinkle_effect,
        std::size_t storage_bytes)
        : pass(std::move(made)), wrinkles(std::move(wrinkle_effect)), shapes(storage_bytes),
          ring(device.caps(), "readback", 1 << 16), graph(device) {}

    DeformPass pass;
    WrinkleEffect wrinkles;
    MeshPool meshes;
    DeformedList shapes;
    gpu::RingBuffer ring;
    FrameGraph graph;
};

void SkinReadback::Deleter::operator()(Machine* machine) const {
    delete machine;
}

SkinReadback::SkinReadback(std::unique_ptr<Machine, Deleter> machine)
    : machine_(std::move(machine)) {}

Result<SkinReadback> SkinReadback::create(gpu::Device& device, std::size_t storage_bytes) {
    Result<DeformPass> pass = create_deform_pass(device);
    if (!pass) {
        return pass.error();
    }
    Result<WrinkleEffect> wrinkles = WrinkleEffect::create(device, RenderSettings{});
    if (!wrinkles) {
        return wrinkles.error();
    }
    const auto most = static_cast<std::size_t>(device.caps().max_storage_bytes);
    return SkinReadback(std::unique_ptr<Machine, Deleter>(new Machine(
        device, *std::move(pass), *std::move(wrinkles), storage_bytes > 0 ? storage_bytes : most)));
}

const DeformedList& SkinReadback::shapes() const {
    return machine_->shapes;
}

void SkinReadback::forget() {
    machine_->shapes.forget();
    machine_->meshes.clear();
}

std::vector<SkinReadbackVertices> SkinReadback::run(
    const World& world, std::span<const Entity> drawn, float alpha, float previous_alpha,
    bool before, int views) {
    Machine& m = *machine_;
    const auto& assets = world.resource<Assets>();
    m.meshes.update(assets.meshes);
    m.ring.begin_frame();
    m.graph.begin_frame();
    m.shapes.update(world, m.meshes, alpha, previous_alpha);
    for (int view = 0; view < views; ++view) {
        for (const Entity entity : drawn) {
            const std::uint32_t index = m.shapes.find(entity);
            if (index != DeformedList::kNone) {
                m.shapes.request(index, before);
            }
        }
    }
    m.shapes.write_jobs(m.ring);
    deform_meshes(m.graph, m.pass, m.shapes);
    FrameData frame;
    frame.world = &world;
    frame.shapes = &m.shapes;
    frame.meshes = &m.meshes;
    frame.ring = &m.ring;
    m.wrinkles.draw_shared(m.graph, frame);
    m.graph.execute();
    m.ring.end_frame();
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);

    std::vector<SkinReadbackVertices> skins;
    for (const Entity entity : drawn) {
        SkinReadbackVertices& skin = skins.emplace_back();
        const std::uint32_t index = m.shapes.find(entity);
        if (index == DeformedList::kNone) {
            continue;
        }
        const auto first = static_cast<std::size_t>(m.shapes.request(index, false));
        const std::size_t count = assets.meshes[m.shapes[index].mesh.index].positions.size();
        const DeformedVertices& vertices = m.shapes.vertices();
        skin.positions = read<Vec3>(vertices.positions(), first, count);
        if (before) {
            skin.before = read<Vec3>(vertices.previous_positions(), first, count);
        }
        if (m.shapes[index].wrinkled) {
            for (const std::uint64_t packed :
                 read<std::uint64_t>(vertices.wrinkles(), first, count)) {
                skin.wrinkles.push_back(glm::unpackHalf4x16(packed));
            }
        }
        if ((m.shapes[index].hooks.of(kWrinkleHook) & kWrinkleDisplaced) != 0) {
            skin.folds = read<float>(vertices.fold_heights(), first, count);
        }
        for (const PackedFrame& v : read<PackedFrame>(vertices.frames(), first, count)) {
            skin.normals.emplace_back(
                from_snorm(v.normal[0]), from_snorm(v.normal[1]), from_snorm(v.normal[2]));
            skin.tangents.emplace_back(
                from_snorm(v.tangent[0]), from_snorm(v.tangent[1]), from_snorm(v.tangent[2]),
                from_snorm(v.tangent[3]));
        }
    }
    return skins;
}

}  // namespace limn::oracle

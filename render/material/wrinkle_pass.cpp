#include "render/material/wrinkle_pass.h"

#include "ecs/components/transform.h"
#include "ecs/components/wrinkle_comparison.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/device.h"
#include "render/gpu/grown_buffer.h"
#include "render/gpu/shader_library.h"
#include "render/material/wrinkle_hook.h"
#include "render/shaders/wrinkle_columns_gpu.h"
#include "render/shaders/wrinkle_gpu.h"
#include "render/skinning/deformed_list.h"

#include <glm/packing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

// Techniques: wrinkle.compression.fallback, wrinkle.compression.integration,
//     wrinkle.compression.interp-bump, wrinkle.dimples, wrinkle.smoothing

namespace limn {
namespace {

constexpr std::uint32_t kInitialTexels = 1 << 14;

static_assert(kFoldSteps == layout::kFoldSteps);
static_assert(static_cast<std::uint32_t>(WrinkleDriver::Strain) == layout::kWrinkleByStrain);
static_assert(static_cast<std::uint32_t>(WrinkleDriver::Radial) == layout::kWrinkleByRadius);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Isometric) == layout::kWrinkleIsometric);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Blend) == layout::kWrinkleBlend);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::StrainView) == layout::kWrinkleStrainView);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Model) == layout::kWrinkleModel);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Photo) == layout::kWrinklePhoto);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Alpha) == layout::kWrinkleAlpha);
static_assert(static_cast<std::uint32_t>(WrinkleMethod::Bump) == layout::kWrinkleBump);

layout::WrinkleColumns
pack_columns(const std::vector<WrinkleMethod>& methods, const Vec2& borders) {
    layout::WrinkleColumns packed{};
    packed.left = borders.x;
    packed.right = borders.y;
    for (const WrinkleMethod method : methods) {
        packed.methods |= static_cast<std::uint32_t>(method) << (4 * packed.count);
        ++packed.count;
    }
    return packed;
}

struct Texel {
    std::uint32_t x;
    std::uint32_t y;
};

std::uint32_t bits(float x) {
    return std::bit_cast<std::uint32_t>(x);
}

bool counts_by_stretch(const WrinkleRest& rest, const WrinkleCorner& at) {
    return at.corner / 3 >= rest.stretch_from;
}

/// The two other corners of a triangle, and the direction across wrinkles in the edges to them.
void append_corner(const WrinkleRest& rest, const WrinkleCorner& at, std::vector<Texel>& texels) {
    const std::uint32_t triangle = at.corner / 3;
    const std::uint32_t corner = at.corner % 3;
    const Vec2& across = rest.across[triangle];
    const float weights[3] = {-across.x - across.y, across.x, across.y};  // of the corners
    const std::uint32_t next = (corner + 1) % 3;
    const std::uint32_t last = (corner + 2) % 3;
    const float factor = rest.mean_length ? at.weight : std::sqrt(at.weight);
    const std::uint32_t mark = (counts_by_stretch(rest, at) ? layout::kWrinkleStretch : 0u)
                               | (rest.wide ? layout::kWrinkleAway : 0u);
    texels.push_back({rest.corners[3 * triangle + next] | mark, rest.corners[3 * triangle + last]});
    texels.push_back({bits(factor * weights[next]), bits(factor * weights[last])});
    if (mark != 0) {
        texels.push_back({bits(at.weight), rest.corners[at.corner]});
    }
}

/// Stores `number(v)` with each vertex.
template <typename Number>
void append_rest(const WrinkleRest& rest, std::vector<Texel>& texels, Number number) {
    const std::size_t begin = texels.size();
    for (std::size_t v = 0; v < rest.first.size(); ++v) {
        texels.push_back({0, number(v)});
    }
    for (std::size_t v = 0; v < rest.first.size(); ++v) {
        texels[begin + v].x = static_cast<std::uint32_t>(texels.size());
        const std::uint32_t end = v + 1 < rest.first.size() ? rest.first[v + 1] : rest.first[v];
        for (std::uint32_t i = rest.first[v]; i < end; ++i) {
            append_corner(rest, rest.around[i], texels);
        }
    }
}

/// The mask of a vertex, and its shortening at rest.
std::uint32_t pack_mask(const WrinkleState& state, const std::vector<float>& mask, std::size_t v) {
    const float resting = v < state.resting.size() ? state.resting[v] : 0.0f;
    return v < mask.size() ? glm::packUnorm2x16({mask[v], resting}) : 0u;
}

/// All blocks, or one of vertices without triangles if there are none; then the heights.
std::vector<Texel> rest_texels(const WrinkleState& state) {
    std::vector<Texel> texels;
    const auto number = [&state](std::size_t block) {
        return [&state, block](std::size_t v) {
            if (block > 0 && !state.second_mask.empty()) {
                return pack_mask(state, state.second_mask, v);
            }
            if (block > 0) {
                return v < state.frames.size() ? bits(state.frames[v][static_cast<int>(block) - 1])
                                               : 0u;
            }
            return pack_mask(state, state.mask, v);
        };
    };
    for (std::size_t block = 0; block < state.rests.size(); ++block) {
        append_rest(state.rests[block], texels, number(block));
    }
    if (state.rests.empty()) {
        WrinkleRest none;
        none.first.resize(state.mask.size() + 1);
        append_rest(none, texels, number(0));
    }
    for (const Vec2& height : state.heights) {
        texels.push_back({bits(height.x), bits(height.y)});
    }
    return texels;
}

/// Texels of a block.
std::uint32_t block_texels(const WrinkleRest& rest) {
    const auto marked = std::ranges::count_if(rest.around, [&](const WrinkleCorner& at) {
        return rest.wide || counts_by_stretch(rest, at);
    });
    return static_cast<std::uint32_t>(rest.first.size() + 2 * rest.around.size())
           + static_cast<std::uint32_t>(marked);
}

/// The texels of a state, uploaded on first use.
const WrinkleRestPool::Range& find_rest(WrinkleRestPool& pool, const WrinkleState& state) {
    const auto [found, fresh] = pool.ranges.try_emplace(state.source);
    WrinkleRestPool::Range& range = found->second;
    range.used = true;
    if (fresh) {
        const std::vector<Texel> texels = rest_texels(state);
        range.texel_count = static_cast<std::uint32_t>(texels.size());
        const std::uint32_t old = pool.slots.capacity();
        range.first_texel = pool.slots.allocate_or_grow(range.texel_count, kInitialTexels);
        if (pool.slots.capacity() > old) {
            pool.texels = gpu::grown_buffer(
                "wrinkle rest", pool.texels, old * sizeof(Texel),
                pool.slots.capacity() * sizeof(Texel));
        }
        pool.texels.write(range.first_texel * sizeof(Texel), std::span<const Texel>(texels));
    }
    return range;
}

void forget_unused(WrinkleRestPool& pool) {
    for (auto at = pool.ranges.begin(); at != pool.ranges.end();) {
        WrinkleRestPool::Range& range = at->second;
        if (range.used) {
            range.used = false;
            ++at;
        } else {
            pool.slots.release(range.first_texel, range.texel_count);
            at = pool.ranges.erase(at);
        }
    }
}

/// A source identifies a mesh by its index, which is ambiguous between Assets.
void forget_others(WrinkleRestPool& pool, std::uint64_t assets) {
    if (pool.assets != assets) {
        forget_unused(pool);
        pool.assets = assets;
    }
}

/// Weights of the drawing method and of alpha, which replaces it at a distance.
struct TierWeights {
    float own = 1;
    float shade = 0;
};

/// Whether the method can be drawn without tangents.
bool is_shade(WrinkleMethod method) {
    return method == WrinkleMethod::Alpha || method == WrinkleMethod::Directional
           || method == WrinkleMethod::Photo;
}

TierWeights tier_weights(
    const WrinkleSurface& surface, float distance, bool tangents, const WrinkleRungs& rungs,
    bool has_maps) {
    const float any = rungs.maps * fade_until(surface.none_from, distance);
    const float own = is_shade(surface.method) ? 1.0f
                      : tangents ? rungs.strain * fade_until(surface.shade_from, distance)
                                 : 0.0f;
    // Maps of the whole face replace slopes, too.
    return {.own = any * own, .shade = has_maps && tangents ? 0.0f : any * (1 - own)};
}

/// Distance from the camera to the center of an instance [m].
float distance_to_shape(const FrameData& frame, Entity entity, const DeformedInstance& shape) {
    const auto* const transform = frame.world->find<WorldTransform>(entity);
    const Vec3 center = 0.5f * (shape.bounds.min + shape.bounds.max);
    const Vec3 at = transform != nullptr ? transform_point(transform->world, center) : center;
    const Affine& eye = frame.camera.world_from_camera;
    return glm::distance(at, Vec3(eye.row[0].w, eye.row[1].w, eye.row[2].w));
}

layout::WrinkleJob make_job(
    const WrinkleSurface& surface, const WrinkleState& state, const WrinkleRestPool::Range& rest,
    const TierWeights& weights, const DeformedInstance& shape) {
    layout::WrinkleJob job{};
    job.rest = rest.first_texel;
    job.displacement = shape.displacement;
    job.resting = shape.resting;
    if (!state.heights.empty()) {
        job.heights = rest.texel_count - static_cast<std::uint32_t>(state.heights.size());
    }
    job.method = static_cast<std::uint32_t>(surface.method);
    job.lambda = surface.lambda;
    job.beta = surface.beta;
    job.slack = surface.slack;
    job.fold_fraction = surface.share;
    job.driver = static_cast<std::uint32_t>(used_driver(surface));
    job.mean_length = !state.rests.empty() && state.rests[0].mean_length ? 1u : 0u;
    job.activation = surface.activation;
    job.own_weight = weights.own;
    job.shade_weight = weights.shade;
    if (state.rests.size() > 1) {
        job.second = block_texels(state.rests[0]);
    }
    if (state.rests.size() == 3) {
        job.third = job.second + block_texels(state.rests[1]);
    }
    for (int i = 0; i < kFoldSteps; ++i) {
        job.folds[i / 4][i % 4] = state.folds[static_cast<std::size_t>(i)];
    }
    return job;
}

}  // namespace

bool WrinkleEffect::is_used(const FrameData& frame) {
    return frame.world->query<const WrinkleState>().count() > 0;
}

Result<WrinkleEffect> WrinkleEffect::create(gpu::Device& device, const RenderSettings&) {
    WrinkleEffect effect;
    effect.program = LIMN_TRY(device.shaders().load({.compute = "wrinkle.comp"}));
    return effect;
}

bool WrinkleEffect::prepare(const FrameData& frame, ViewData& view) {
    const auto* comparison = frame.world->find_resource<WrinkleComparison>();
    view.publish_block(
        layout::kWrinkleColumnsBinding,
        pack_columns(wrinkle_columns(comparison), column_borders(comparison)));
    Variant& lit = view.lighting.variant;
    const auto has = [&](unsigned bits) { return frame.shapes->has_hook(kWrinkleHook, bits); };
    lit.add_if(
        has(kWrinkleBlend | kWrinkleFade | kWrinkleBounce | kWrinkleShade), "SMOOTH_NORMALS");
    lit.add_if(has(kWrinkleShade), "SHADED_SKIN");
    lit.add_if(has(kWrinkleBlend), "BLENDED_SKIN");
    lit.add_if(has(kWrinkleBounce), "FOLD_LIGHT");
    return true;
}

void WrinkleEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    forget_others(pool, frame.assets_identity);
    std::vector<layout::WrinkleJob> job_list;
    std::vector<std::uint32_t> group_list;
    std::uint32_t first = ~0u;
    std::uint32_t end = 0;
    bool displaced = false;
    frame.shapes->each_requested([&](Entity entity, const DeformedInstance& shape,
                                     std::uint32_t slot, std::uint32_t count) {
        if (!shape.wrinkled) {
            return;
        }
        const auto& state = *frame.world->find<WrinkleState>(entity);
        const auto& surface = *frame.world->find<WrinkleSurface>(entity);
        const auto* rungs = frame.world->find<WrinkleRungs>(entity);
        const TierWeights weights = tier_weights(
            surface, distance_to_shape(frame, entity, shape),
            frame.meshes->meshes()[shape.mesh.index].tangents,
            rungs != nullptr ? *rungs : WrinkleRungs{},
            rungs != nullptr && frame.world->find<WrinkleMaps>(entity) != nullptr);
        layout::WrinkleJob job = make_job(surface, state, find_rest(pool, state), weights, shape);
        displaced = displaced || job.heights != 0;
        if (shape.wrinkle_columns) {
            job.method = layout::kWrinkleColumns;
        }
        job.vertex_count = count;
        job.slot = slot;
        job.first_group = static_cast<std::uint32_t>(group_list.size());
        const std::uint32_t needed = (count + layout::kWrinkleGroup - 1) / layout::kWrinkleGroup;
        group_list.insert(group_list.end(), needed, static_cast<std::uint32_t>(job_list.size()));
        job_list.push_back(job);
        first = std::min(first, slot);
        end = std::max(end, slot + count);
    });
    forget_unused(pool);
    if (job_list.empty()) {
        return;
    }
    jobs.upload(*frame.ring, job_list);
    groups.upload(*frame.ring, group_list);
    rest.set(pool.texels);
    DeformedVertices& vertices = frame.shapes->vertices();
    vertices.require_wrinkles();
    if (displaced) {
        vertices.require_fold_heights();
    }
    const Use positions = graph.import("deformed positions", vertices.positions());
    std::vector<Use> writes = {graph.import("wrinkle strengths", vertices.wrinkles())};
    if (displaced) {
        writes.emplace_back(graph.import("fold heights", vertices.fold_heights()));
    }
    const std::uint32_t aligned = first / layout::kWrinkleGroup * layout::kWrinkleGroup;
    const auto group_count = static_cast<std::uint32_t>(group_list.size());
    graph.add_pass(
        "wrinkles", std::span<const Use>(&positions, 1), std::span<const Use>(writes),
        [this, &vertices, aligned, end, group_count, displaced](PassContext& context) {
            gpu::Device& device = context.device();
            device.use(*program);
            jobs.bind(device, layout::kWrinkleJobsUnit);
            groups.bind(device, layout::kWrinkleGroupsUnit);
            rest.bind(device, layout::kWrinkleRestUnit);
            const auto bind = [&](unsigned binding, const gpu::Buffer& buffer, std::size_t stride) {
                device.bind_storage(
                    binding, buffer.id(), aligned * stride, (end - aligned) * stride);
            };
            bind(layout::kWrinklePositionsBinding, vertices.positions(), sizeof(Vec3));
            bind(
                layout::kWrinklesBinding, vertices.wrinkles(),
                stream_stride(VertexStream::Wrinkle));
            // Without displaced skin none are written.
            const VertexStream last = displaced ? VertexStream::FoldHeight : VertexStream::Wrinkle;
            bind(layout::kFoldHeightsBinding, vertices.streams().buffer(last), stream_stride(last));
            program->set("group_count", group_count);
            program->set("first_vertex", aligned);
            const unsigned wide = std::min(group_count, layout::kWrinkleGroupsWide);
            device.dispatch(wide, (group_count + wide - 1) / wide);
        });
}

}  // namespace limn

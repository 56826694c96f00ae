#include "render/skinning/deformed_list.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/transform.h"
#include "ecs/components/vertex_offset.h"
#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_comparison.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/buffer_texture.h"
#include "render/material/wrinkle_hook.h"
#include "render/skinning/deform_source.h"
#include "render/skinning/skin_palette.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>

// Techniques: char.skin-gpu, char.skin-vertex-offset

namespace limn {
namespace {

constexpr std::size_t kEvaluateGrain = 16;

/// Hash of everything that determines how folds displace vertices, except positions. Never 0.
std::uint64_t hash_folds(const WrinkleSurface& surface, std::uint64_t source, float displacement) {
    std::uint64_t hash = hash_combine(source, static_cast<std::uint64_t>(surface.method));
    for (const float number :
         {surface.lambda, surface.beta, surface.slack, surface.share, surface.activation,
          displacement}) {
        hash = hash_combine(hash, std::bit_cast<std::uint32_t>(number));
    }
    return hash | 1;
}

/// Hash of the state between `before` and `now` at time `alpha`; equal bytes give equal hashes.
template <typename T>
std::uint64_t hash_at(const std::vector<T>& before, const std::vector<T>& now, float alpha) {
    const auto hash_values = [](const std::vector<T>& values) {
        return hash_bytes(values.data(), values.size() * sizeof(T), values.size());
    };
    const bool still = before.size() != now.size() || now.empty()
                       || std::memcmp(before.data(), now.data(), now.size() * sizeof(T)) == 0;
    if (still || alpha == 1.0f) {
        return hash_values(now);
    }
    if (alpha == 0.0f) {
        return hash_values(before);
    }
    return hash_combine(
        hash_combine(hash_values(before), hash_values(now)), std::bit_cast<std::uint32_t>(alpha));
}

/// Hash of the values that jump in this step but are still shown before their jump; 0 if there are
/// none.
template <typename T>
std::uint64_t hash_before_jumps(const std::vector<ValueJump<T>>& jumps, float shown) {
    std::uint64_t hash = 0;
    for (const ValueJump<T>& jump : jumps) {
        if (shown < jump.at) {
            hash = hash_bytes(&jump.before, sizeof jump.before, hash_combine(hash, jump.index));
        }
    }
    return hash;
}

/// Texels at time `alpha` between the last two steps.
std::vector<Vec4>
mix_texels(const std::vector<Vec4>& previous, const std::vector<Vec4>& now, float alpha) {
    std::vector<Vec4> texels = now;
    for (std::size_t i = 0; previous.size() == now.size() && i < now.size(); ++i) {
        texels[i] = glm::mix(previous[i], now[i], alpha);
    }
    return texels;
}

std::vector<Vec4> make_controls(const DeformerState* state, float alpha) {
    return state != nullptr ? mix_texels(state->previous, state->now, alpha) : std::vector<Vec4>{};
}

bool shows_patches_before(const SurfaceBindingState& state, const StepTime& time) {
    return state.patches_jump.at != kNoJump && time.is_before(state.patches_jump.at);
}

std::vector<Vec4> make_patches(const SurfaceBindingState* state, const StepTime& time) {
    if (state == nullptr) {
        return {};
    }
    return shows_patches_before(*state, time)
               ? state->patches_jump.before
               : mix_texels(state->previous_patches, state->patches, time.alpha);
}

std::span<const SurfaceAnchor> anchors_of(const World& world, Entity entity) {
    const auto* binding = world.find<SurfaceBindingState>(entity);
    return binding != nullptr && binding->anchors != nullptr
               ? std::span<const SurfaceAnchor>(*binding->anchors)
               : std::span<const SurfaceAnchor>{};
}

/// Weight of a shape, clamped to 0 .. 1; 1 if there is none.
float weight_of(const std::vector<float>& weights, std::uint32_t shape) {
    return shape == kNoAsset        ? 1.0f
           : shape < weights.size() ? std::clamp(weights[shape], 0.0f, 1.0f)
                                    : 0.0f;
}

bool is_finite(const Bounds& box) {
    const Vec3 sum = box.min + box.max;
    return std::isfinite(sum.x + sum.y + sum.z);
}

}  // namespace

DeformedList::Entry& DeformedList::entry_of(Entity entity) {
    index_of_.resize(std::max<std::size_t>(index_of_.size(), entity.index + 1), kNone);
    std::uint32_t& index = index_of_[entity.index];
    if (index != kNone && entries_[index].entity == entity) {
        return entries_[index];
    }
    if (index != kNone) {
        release(entries_[index]);  // the entity index was recycled
        free_.push_back(index);
    }
    if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(entries_.size()));
        entries_.emplace_back();
    }
    index = free_.back();
    free_.pop_back();
    entries_[index] = {};
    entries_[index].entity = entity;
    return entries_[index];
}

void DeformedList::release(Entry& entry) {
    if (entry.allocated) {
        vertices_.release(entry.first_vertex, entry.vertex_count);
    }
    entry.allocated = false;
    entry.drawn = 0;
    entry.drawn_previous = 0;
}

void DeformedList::forget() {
    entries_.clear();
    free_.clear();
    index_of_.clear();
    active_.clear();
    reported_.clear();
    rest_.clear();
    vertices_.clear();
}

void DeformedList::report(const std::string& fault) {
    if (reported_.insert(fault).second) {
        log_warn("{}; drawn in rest pose", fault);
    }
}

bool DeformedList::resolve(
    const World& world, const Assets& assets, Entry& entry, std::string& fault) {
    entry.rest = &rest_.get(assets, entry.mesh, anchors_of(world, entry.entity));
    if (!entry.rest->fault.empty()) {
        const std::string& name = assets.meshes[entry.mesh.index].name;
        fault = fmt::format("deformed mesh {} {}", name, entry.rest->fault);
        return false;
    }
    DeformSource source = find_deform_source(
        world, assets, entry.entity, entry.mesh, entry.rest->joint_count, entry.settings);
    if (finest && source.wanted_joints > 0 && source.pose != nullptr) {
        // The pose is that of the coarser mesh in use. What is compiled does not depend on it.
        Pose& whole = whole_poses_.emplace_back(*source.pose);
        whole.joints.resize(source.wanted_joints);
        source.pose = &whole;
        source.fault.clear();
    }
    entry.skin = source.skin;
    entry.pose = source.pose;
    entry.morphs = source.morphs;
    entry.deformers = source.deformers;
    entry.surface = source.surface;
    fault = std::move(source.fault);
    entry.by_offsets =
        fault.empty() && entry.skin != nullptr && entry.settings.skinning == Skinning::Linear
        && world.has<VertexOffsetSkinning>(entry.entity) && entry.deformers == nullptr
        && entry.surface == nullptr && entry.rest->bounds.morphs.empty();
    return fault.empty();
}

const RestMesh&
DeformedList::rest_of(const World& world, const Assets& assets, const Entry& entry) {
    return entry.by_offsets ? rest_.get_joint_offsets(assets, entry.mesh, entry.settings.skin)
                            : rest_.get(assets, entry.mesh, anchors_of(world, entry.entity));
}

void DeformedList::find_wrinkles(
    const World& world, const std::vector<WrinkleMethod>& columns, const Vec3& eye,
    Entry& entry) const {
    const auto* wrinkles = world.find<WrinkleState>(entry.entity);
    const auto* surface = world.find<WrinkleSurface>(entry.entity);
    const auto* rungs = world.find<WrinkleRungs>(entry.entity);
    entry.wrinkled = wrinkles != nullptr && surface != nullptr
                     && surface->method != WrinkleMethod::None
                     && (rungs == nullptr || rungs->maps > 0 || finest)
                     && wrinkles->mask.size() == entry.rest->vertex_count;
    entry.wrinkle_columns = entry.wrinkled && !columns.empty() && has_columns(*surface)
                            && meshes_->meshes()[entry.mesh.index].tangents;
    unsigned features = 0;
    if (entry.wrinkled) {
        const bool shades = !meshes_->meshes()[entry.mesh.index].tangents
                            || (rungs != nullptr && !world.has<WrinkleMaps>(entry.entity));
        features = entry.wrinkle_columns ? column_features(*surface, columns)
                                         : wrinkle_features(*surface, shades);
    }
    const bool displaced = entry.wrinkled && !entry.wrinkle_columns && is_displaced(*surface)
                           && wrinkles->heights.size() == entry.rest->vertex_count;
    if (displaced) {
        features |= kWrinkleDisplaced;
    }
    entry.hooks.set(kWrinkleHook, static_cast<std::uint16_t>(features));
    entry.resting_shape = entry.wrinkled ? wrinkles->resting_shape : kNoAsset;
    entry.displacement = 0;
    entry.folds = 0;
    entry.largest_fold = 0;
    if (!displaced) {
        return;
    }
    const Vec3 world_center = transform_point(
        world.get<WorldTransform>(entry.entity).world,
        center(meshes_->meshes()[entry.mesh.index].bounds));
    entry.displacement =
        surface->displacement * (rungs != nullptr ? rungs->displaced : 1.0f)
        * fade_until(surface->displacement_until, glm::distance(world_center, eye));
    if (entry.displacement > 0) {
        entry.largest_fold = wrinkles->largest_fold;
        entry.folds = hash_folds(*surface, wrinkles->source, entry.displacement);
    }
}

void DeformedList::make_entry_palette(
    const Entry& entry, const StepTime& time, std::vector<Affine>& palette) {
    if (entry.by_offsets) {
        make_joint_palette(entry.skin, entry.pose, time, palette, entry.rest->joint_count);
    } else {
        make_palette(
            entry.skin, entry.pose, entry.settings.skinning, time, palette,
            entry.rest->joint_count);
    }
}

void DeformedList::evaluate(Entry& entry) const {
    const Deformed& settings = entry.settings;
    const auto hash_shape = [&](float alpha) {
        std::uint64_t shape = hash_combine(entry.mesh.index, settings.skin.index);
        shape = hash_combine(shape, entry.mesh_version);
        shape = hash_combine(shape, static_cast<std::uint64_t>(settings.skinning));
        shape = hash_combine(shape, settings.first_morph);
        shape = entry.by_offsets ? hash_combine(shape, 1) : shape;
        if (entry.skin != nullptr) {
            shape = hash_combine(shape, hash_at(entry.pose->previous, entry.pose->joints, alpha));
            shape ^= hash_before_jumps(entry.pose->jumps, alpha_);
        }
        if (entry.morphs != nullptr) {
            shape =
                hash_combine(shape, hash_at(entry.morphs->previous, entry.morphs->weights, alpha));
            shape ^= hash_before_jumps(entry.morphs->jumps, alpha_);
        }
        if (entry.deformers != nullptr) {
            shape = hash_combine(
                shape, hash_at(entry.deformers->previous, entry.deformers->now, alpha));
        }
        if (entry.surface != nullptr) {
            shape = hash_combine(
                shape, hash_at(entry.surface->previous_patches, entry.surface->patches, alpha));
            const std::vector<Vec4>& before = entry.surface->patches_jump.before;
            shape = shows_patches_before(*entry.surface, {alpha, alpha_})
                        ? hash_bytes(before.data(), before.size() * sizeof(Vec4), shape)
                        : shape;
        }
        if (entry.folds != 0) {
            shape = hash_combine(shape, entry.folds);
        }
        return shape | 1;
    };
    entry.shape = hash_shape(alpha_);
    entry.previous_shape = hash_shape(previous_alpha_);
    if (entry.evaluated == entry.shape) {
        return;
    }
    entry.evaluated = entry.shape;
    const StepTime now = {alpha_, alpha_};
    make_entry_palette(entry, now, entry.palette);
    make_morph_weights(
        entry.morphs, settings.first_morph, entry.rest->bounds.morphs.size(), now, entry.weights);
    entry.controls = make_controls(entry.deformers, alpha_);
    entry.patches = make_patches(entry.surface, now);
    float displacement = max_displacement(entry.controls) + entry.largest_fold;
    if (entry.surface != nullptr) {
        displacement +=
            max_motion(entry.surface->rest_patches, entry.patches, entry.surface->largest_offset);
    }
    entry.bounds = posed_bounds(
        entry.rest->bounds, entry.palette, settings.skinning, entry.weights, displacement);
}

void DeformedList::update(
    const World& world, const MeshPool& meshes, float alpha, float previous_alpha,
    const Vec3& eye) {
    meshes_ = &meshes;
    alpha_ = alpha;
    previous_alpha_ = previous_alpha;
    active_.clear();
    whole_poses_.clear();
    for (Entry& entry : entries_) {
        entry.found = false;
        entry.active = false;
        entry.requested = false;
        entry.previous_requested = false;
    }
    const auto* assets = world.find_resource<Assets>();
    if (assets == nullptr) {
        return;
    }
    world.query<const Deformed, const MeshInstance, With<WorldTransform>>().each(
        [&](Entity entity, const Deformed& settings, const MeshInstance& instance) {
            const auto* levels = finest ? world.find<MeshLevels>(entity) : nullptr;
            const MeshId drawn = levels != nullptr && !levels->meshes.empty()
                                     ? levels->meshes.back()
                                     : instance.mesh;
            const std::uint32_t mesh = drawn.index;
            if (mesh >= meshes.meshes().size() || meshes.meshes()[mesh].index_count == 0) {
                return;
            }
            Entry& entry = entry_of(entity);
            const std::uint32_t version = meshes.meshes()[mesh].version;
            if (entry.mesh != drawn || entry.mesh_version != version) {
                release(entry);
                entry.evaluated = 0;
            }
            entry.found = true;
            entry.mesh = drawn;
            entry.mesh_version = version;
            entry.settings = settings;
            std::string fault;
            entry.active = resolve(world, *assets, entry, fault);
            if (entry.active) {
                active_.push_back(static_cast<std::uint32_t>(&entry - entries_.data()));
            } else {
                report(fault);
            }
        });
    // Adding a mesh may have reallocated the pool.
    const std::vector<WrinkleMethod> columns =
        wrinkle_columns(world.find_resource<WrinkleComparison>());
    for (const std::uint32_t i : active_) {
        Entry& entry = entries_[i];
        entry.rest = &rest_of(world, *assets, entry);
        find_wrinkles(world, columns, eye, entry);
    }
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
        Entry& entry = entries_[i];
        if (!entry.active) {
            release(entry);
        }
        if (!entry.found && !entry.entity.is_null()) {
            index_of_[entry.entity.index] = kNone;
            entry = {};
            free_.push_back(i);
        }
    }
    parallel_for(active_.size(), kEvaluateGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Entry& entry = entries_[active_[i]];
            evaluate(entry);
            entry.resting = weight_of(entry.weights, entry.resting_shape);
        }
    });
    for (const std::uint32_t i : active_) {
        Entry& entry = entries_[i];
        if (!is_finite(entry.bounds)) {
            entry.active = false;
            release(entry);
            report(fmt::format(
                "deformed mesh {}: pose or morph weights of its character are not finite",
                assets->meshes[entry.mesh.index].name));
        }
    }
}

bool DeformedList::has_hook(const SurfaceHook& hook, unsigned bits) const {
    return std::ranges::any_of(
        active_, [&](std::uint32_t i) { return (entries_[i].hooks.of(hook) & bits) != 0; });
}

std::int32_t DeformedList::request(std::uint32_t index, bool before) {
    Entry& entry = entries_[index];
    if (!entry.allocated) {
        entry.vertex_count = entry.rest->vertex_count;
        entry.first_vertex = vertices_.allocate(*meshes_, meshes_->meshes()[entry.mesh.index]);
        entry.allocated = true;
    }
    entry.requested = true;
    entry.previous_requested = entry.previous_requested || before;
    if (before) {
        vertices_.require_previous_positions();
    }
    return static_cast<std::int32_t>(entry.first_vertex);
}

/// What must be recomputed for a shape; 0 if nothing.
std::uint32_t DeformedList::flags_of(const Entry& entry) {
    std::uint32_t flags = 0;
    if (entry.drawn != entry.shape) {
        flags |= layout::kDeformCurrent;
    }
    if (entry.previous_requested && entry.drawn_previous != entry.previous_shape) {
        flags |= entry.drawn == entry.previous_shape ? layout::kDeformCopyPrevious
                                                     : layout::kDeformPrevious;
    }
    if (!entry.requested || flags == 0) {
        return 0;
    }
    if (entry.skin != nullptr) {
        flags |= layout::kDeformJoints;
        flags |= entry.settings.skinning == Skinning::DualQuaternion ? layout::kDeformDual : 0u;
        flags |= entry.by_offsets ? layout::kDeformOffsets : 0u;
    }
    return flags | (entry.weights.empty() ? 0u : layout::kDeformMorphs)
           | (entry.controls.empty() ? 0u : layout::kDeformControls)
           | (entry.patches.empty() ? 0u : layout::kDeformPatches);
}

void DeformedList::add_job(Entry& entry, std::uint32_t flags) {
    const auto add_palette = [&](const std::vector<Affine>& palette) {
        const auto first = static_cast<std::uint32_t>(palette_texels_.size());
        append_texels(palette, entry.settings.skinning, palette_texels_);
        return first;
    };
    const auto add_weights = [&](const std::vector<float>& values) {
        const auto first = static_cast<std::uint32_t>(weights_.size());
        weights_.insert(weights_.end(), values.begin(), values.end());
        return first;
    };
    const auto add_controls = [&](const std::vector<Vec4>& values) {
        const auto first = static_cast<std::uint32_t>(controls_.size());
        controls_.insert(controls_.end(), values.begin(), values.end());
        return first;
    };
    layout::DeformJob job{};
    job.rest = entry.rest->first_texel;
    job.vertex_count = entry.vertex_count;
    job.slot = entry.first_vertex;
    job.first_group = static_cast<std::uint32_t>(groups_.size());
    if ((flags & layout::kDeformPrevious) != 0) {
        const Deformed& settings = entry.settings;
        std::vector<Affine> palette;
        std::vector<float> weights;
        const StepTime then = {previous_alpha_, alpha_};
        make_entry_palette(entry, then, palette);
        make_morph_weights(entry.morphs, settings.first_morph, entry.weights.size(), then, weights);
        job.previous_palette = add_palette(palette);
        job.previous_weights = add_weights(weights);
        job.previous_controls = add_controls(make_controls(entry.deformers, previous_alpha_));
        job.previous_patches = add_controls(make_patches(entry.surface, then));
    }
    if ((flags & (layout::kDeformPrevious | layout::kDeformCopyPrevious)) != 0) {
        entry.drawn_previous = entry.previous_shape;
    }
    if ((flags & layout::kDeformCurrent) != 0) {
        job.palette = add_palette(entry.palette);
        job.weights = add_weights(entry.weights);
        job.controls = add_controls(entry.controls);
        job.patches = add_controls(entry.patches);
        entry.drawn = entry.shape;
    }
    const std::uint32_t groups =
        (job.vertex_count + layout::kDeformGroup - 1) / layout::kDeformGroup;
    groups_.insert(groups_.end(), groups, static_cast<std::uint32_t>(jobs_.size()));
    jobs_.push_back(job);

    // As many per dispatch as fit into one storage block.
    const std::uint32_t end = job.slot + job.vertex_count;
    const auto max_vertices = static_cast<std::uint32_t>(storage_bytes_ / sizeof(PackedFrame));
    if (work_.batches.empty() || work_.batches.back().flags != flags
        || end - work_.batches.back().first_vertex > max_vertices) {
        const std::uint32_t aligned = job.slot / layout::kDeformGroup * layout::kDeformGroup;
        work_.batches.push_back(
            {.flags = flags, .first_group = job.first_group, .first_vertex = aligned});
    }
    DeformBatch& batch = work_.batches.back();
    batch.group_count += groups;
    batch.end_vertex = end;
}

void DeformedList::write_jobs(gpu::RingBuffer& ring) {
    work_ = {};
    due_.clear();
    jobs_.clear();
    groups_.clear();
    palette_texels_.clear();
    weights_.clear();
    controls_.clear();
    if (meshes_ != nullptr) {
        vertices_.use_indices_of(*meshes_);
    }
    for (const std::uint32_t i : active_) {
        const std::uint32_t flags = flags_of(entries_[i]);
        if (flags != 0) {
            due_.push_back({flags, entries_[i].first_vertex, i});
        }
    }
    if (due_.empty()) {
        return;
    }
    std::sort(due_.begin(), due_.end());
    for (const Due& due : due_) {
        add_job(entries_[due.entry], due.flags);
        work_.vertices += entries_[due.entry].vertex_count;
    }
    work_.instances = static_cast<int>(due_.size());
    const auto push = [&](const auto& items) {
        const std::span bytes = std::as_bytes(std::span(items));
        const gpu::RingSlice slice =
            ring.allocate(std::max<std::size_t>(bytes.size(), 16), BufferTexture::alignment());
        std::copy(bytes.begin(), bytes.end(), slice.data);  // of a list that may be empty
        return slice;
    };
    work_.jobs = push(jobs_);
    work_.groups = push(groups_);
    work_.palettes = push(palette_texels_);
    work_.weights = push(weights_);
    work_.controls = push(controls_);
}

}  // namespace limn

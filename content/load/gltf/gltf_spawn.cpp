#include "content/load/gltf/gltf_spawn.h"

#include "content/load/asset_lists.h"
#include "content/load/level/component_json.h"
#include "ecs/component_bytes.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/components/placement.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

namespace limn {

namespace {

AssetOffsets append_scene(Assets& assets, GltfScene& scene) {
    Assets own;
    own.meshes = std::move(scene.meshes);
    own.materials = std::move(scene.materials);
    own.images = std::move(scene.images);
    own.skins = std::move(scene.skins);
    own.clips = std::move(scene.clips);
    if (!scene.skeleton.joints.empty()) {
        own.skeletons.push_back(std::move(scene.skeleton));
    }
    return append_assets(assets, own);
}

bool is_of_character(const AnyComponent& component) {
    const ComponentInfo* const info = &component.info();
    return info == &component_info<Skeleton>() || info == &component_info<ClipPlayer>()
           || info == &component_info<MorphWeights>();
}

/// Which nodes become entities: joints only where they are needed.
std::vector<bool> find_kept_nodes(const GltfScene& scene, bool has_character) {
    std::vector<bool> keeps(scene.nodes.size(), false);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const GltfNode& node = scene.nodes[i];
        const bool is_joint = scene.joints[i] >= 0;
        const auto components =
            std::count_if(node.components.begin(), node.components.end(), [&](const auto& c) {
                return !has_character || !is_of_character(c);
            });
        keeps[i] = keeps[i] || !is_joint || node.is_named || !node.parts.empty() || node.has_camera
                   || node.light.index() != 0 || components > 0;
        if (!is_joint && node.parent >= 0) {
            keeps[static_cast<std::size_t>(node.parent)] = true;
        }
        for (const AnyComponent& component : node.components) {
            // for_each_entity gives mutable references
            AnyComponent copy = component;
            for_each_entity(copy.info().fields, copy.data(), [&](const Entity& named) {
                if (!named.is_null()) {
                    keeps[named.index] = true;
                }
            });
        }
    }
    return keeps;
}

/// The component of the light, if there is one.
void add_light(World& world, Entity entity, const GltfLight& light) {
    std::visit(
        [&](const auto& value) {
            using T = std::decay_t<decltype(value)>;
            if constexpr (!std::is_same_v<T, std::monostate>) {
                world.add(entity, value);
            }
        },
        light);
}

class GltfSpawner {
  public:
    GltfSpawner(World& world, Assets& assets, GltfScene& scene, Entity parent)
        : world_(world), scene_(scene), parent_(parent) {
        has_joints_ = !scene.skeleton.joints.empty();
        has_clips_ = !scene.clips.empty();
        result_.rig.is_character = has_joints_ || !scene.morph_weights.empty();
        rest_ = find_rest_joints(scene.skeleton);
        scene_.joints.resize(scene_.nodes.size(), -1);
        offsets_ = append_scene(assets, scene);
    }

    SpawnedGltf spawn() {
        make_rig();
        keeps_ = find_kept_nodes(scene_, result_.rig.is_character);
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            entities_.push_back(keeps_[i] ? create(i) : Entity{});
        }
        // After all nodes, since components may reference any of them.
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (keeps_[i]) {
                add_parts(entities_[i], scene_.nodes[i]);
            }
            for (AnyComponent& component : scene_.nodes[i].components) {
                add_component(i, component);
            }
        }
        if (result_.rig.is_character) {
            make_character(world_, parent_, result_.rig);
        }
        return std::move(result_);
    }

  private:
    void make_rig() {
        GltfRig& rig = result_.rig;
        if (!rig.is_character) {
            return;
        }
        if (has_joints_) {
            rig.skeleton = {offsets_.skeletons};
        }
        if (has_clips_) {
            rig.player.clip = {offsets_.clips};
        }
        rig.weights = std::move(scene_.morph_weights);
        if (parent_.is_null()) {
            parent_ = world_.create(Transform{}, Name{scene_.name}, FromGltf{});
            result_.roots.push_back(parent_);
            owns_character_ = true;
        }
    }

    void link(Entity child, Entity parent) {
        const Status linked = set_parent(world_, child, parent);
        LIMN_CHECK(linked.ok());
    }

    Entity create(std::size_t index) {
        const GltfNode& node = scene_.nodes[index];
        const std::int32_t joint = scene_.joints[index];
        const Entity entity = world_.create(
            joint >= 0 ? decompose_affine(rest_[static_cast<std::size_t>(joint)])
                       : Transform{node.transform},
            FromGltf{});
        if (joint >= 0) {
            world_.add(entity, JointAttachment{parent_, static_cast<std::uint16_t>(joint)});
            link(entity, parent_);
        } else if (node.parent >= 0) {
            link(entity, entities_[static_cast<std::size_t>(node.parent)]);
        } else if (!parent_.is_null()) {
            link(entity, parent_);
        }
        if (!owns_character_ && (joint >= 0 || node.parent < 0)) {
            result_.roots.push_back(entity);
        }
        if (!node.name.empty()) {
            world_.add(entity, Name{node.name});
        }
        if (node.has_camera) {
            world_.add(entity, node.camera);
        }
        add_light(world_, entity, node.light);
        return entity;
    }

    void add_parts(Entity entity, const GltfNode& node) {
        for (const GltfPart& part : node.parts) {
            const MeshInstance instance{
                {part.mesh + offsets_.meshes}, {part.material + offsets_.materials}};
            Entity drawn = entity;
            if (node.parts.size() == 1) {
                world_.add(entity, instance);
            } else {
                drawn = world_.create(Transform{}, instance, FromGltf{});
                link(drawn, entity);
            }
            if (node.skin >= 0 || node.first_morph >= 0) {
                Deformed deformed;
                deformed.character = parent_;
                if (node.skin >= 0) {
                    deformed.skin = {static_cast<std::uint32_t>(node.skin) + offsets_.skins};
                }
                deformed.first_morph = static_cast<std::uint32_t>(std::max(node.first_morph, 0));
                world_.add(drawn, deformed);
            }
        }
    }

    void add_component(std::size_t node, AnyComponent& component) {
        const ComponentInfo& info = component.info();
        for_each_entity(info.fields, component.data(), [&](Entity& reference) {
            if (!reference.is_null()) {
                reference = entities_[reference.index];
            }
        });
        offset_asset_ids(info, component.data(), offsets_);
        const bool is_for_character = result_.rig.is_character && is_of_character(component);
        const Entity target = is_for_character ? parent_ : entities_[node];
        if (!is_for_character || !world_.has(target, info.id)) {
            world_.add_move(target, info.id, component.data());
        }
    }

    World& world_;
    GltfScene& scene_;
    Entity parent_;  ///< the character, if the file has one
    bool has_joints_ = false;
    bool has_clips_ = false;
    bool owns_character_ = false;
    AssetOffsets offsets_;
    std::vector<Affine> rest_;
    std::vector<bool> keeps_;
    std::vector<Entity> entities_;  ///< of the nodes; null where there is none
    SpawnedGltf result_;
};

}  // namespace

SpawnedGltf spawn_gltf(World& world, Assets& assets, GltfScene&& scene, Entity parent) {
    LIMN_CHECK(parent.is_null() || world.alive(parent));
    return GltfSpawner(world, assets, scene, parent).spawn();
}

void make_character(World& world, Entity entity, const GltfRig& rig) {
    if (rig.skeleton.index != kNoAsset && world.find<Skeleton>(entity) == nullptr) {
        world.add(entity, Skeleton{rig.skeleton});
    }
    if (ClipPlayer* const player = world.find<ClipPlayer>(entity)) {
        player->clip = player->clip.index == kNoAsset ? rig.player.clip : player->clip;
    } else {
        world.add(entity, rig.player);
    }
    if (rig.weights.empty()) {
        return;
    }
    if (MorphWeights* const morph = world.find<MorphWeights>(entity)) {
        std::vector<float>& weights = morph->weights;
        for (std::size_t i = weights.size(); i < rig.weights.size(); ++i) {
            weights.push_back(rig.weights[i]);
        }
    } else {
        world.add(entity, MorphWeights{rig.weights, {}});
    }
}

}  // namespace limn

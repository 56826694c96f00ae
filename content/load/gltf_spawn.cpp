#include "content/load/gltf_spawn.h"

#include "content/load/component_json.h"
#include "ecs/component_bytes.h"
#include "ecs/components/name.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <iterator>
#include <utility>

namespace limn {

namespace {

/// What the indices of a scene become when its assets stand behind others.
struct Offsets {
    std::uint32_t mesh = 0;
    std::uint32_t material = 0;
    std::uint32_t image = 0;
};

template <typename T>
std::uint32_t append(std::vector<T>& target, std::vector<T>& source) {
    const auto offset = static_cast<std::uint32_t>(target.size());
    target.insert(
        target.end(),
        std::make_move_iterator(source.begin()),
        std::make_move_iterator(source.end()));
    return offset;
}

Offsets append_assets(Assets& assets, GltfScene& scene) {
    const auto image_offset = static_cast<std::uint32_t>(assets.images.size());
    for (Material& material : scene.materials) {
        for (TextureSlot* slot :
             {&material.base_color_texture,
              &material.metal_rough_texture,
              &material.normal_texture,
              &material.occlusion_texture,
              &material.emission_texture}) {
            if (slot->image.index != kNoAsset) {
                slot->image.index += image_offset;
            }
        }
    }
    Offsets offsets;
    offsets.image = append(assets.images, scene.images);
    offsets.mesh = append(assets.meshes, scene.meshes);
    offsets.material = append(assets.materials, scene.materials);
    if (!scene.skeleton.joints.empty()) {
        assets.skeletons.push_back(std::move(scene.skeleton));
    }
    append(assets.skins, scene.skins);
    append(assets.clips, scene.clips);
    return offsets;
}

MeshInstance make_instance(const GltfPart& part, const Offsets& offsets) {
    return {{part.mesh + offsets.mesh}, {part.material + offsets.material}};
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

void add_parts(World& world, Entity entity, const GltfNode& node, const Offsets& offsets) {
    if (node.parts.size() == 1) {
        world.add(entity, make_instance(node.parts[0], offsets));
        return;
    }
    for (const GltfPart& part : node.parts) {
        const Entity child = world.create(Transform{}, make_instance(part, offsets));
        const Status linked = set_parent(world, child, entity);
        LIMN_CHECK(linked.ok());
    }
}

void add_components(
    World& world,
    Entity entity,
    std::vector<AnyComponent>& components,
    const std::vector<Entity>& entities,
    const Offsets& offsets) {
    for (AnyComponent& component : components) {
        const ComponentInfo& info = component.info();
        for_each_entity(info.fields, component.data(), [&](Entity& reference) {
            if (!reference.is_null()) {
                reference = entities[reference.index];
            }
        });
        for_each_asset(
            info.fields, component.data(), [&](std::string_view kind, std::uint32_t& index) {
                if (index != kNoAsset) {
                    index += kind == "mesh"       ? offsets.mesh
                             : kind == "material" ? offsets.material
                                                  : offsets.image;
                }
            });
        world.add_move(entity, info.id, component.data());
    }
}

}  // namespace

std::vector<Entity> spawn_gltf(World& world, Assets& assets, GltfScene&& scene, Entity parent) {
    LIMN_CHECK(parent.is_null() || world.alive(parent));
    const Offsets offsets = append_assets(assets, scene);

    std::vector<Entity> entities;
    std::vector<Entity> roots;
    entities.reserve(scene.nodes.size());
    for (const GltfNode& node : scene.nodes) {
        const Entity entity = world.create(Transform{node.transform});
        const Entity above =
            node.parent < 0 ? parent : entities[static_cast<std::size_t>(node.parent)];
        if (!above.is_null()) {
            const Status linked = set_parent(world, entity, above);
            LIMN_CHECK(linked.ok());
        }
        if (node.parent < 0) {
            roots.push_back(entity);
        }
        if (!node.name.empty()) {
            world.add(entity, Name{node.name});
        }
        if (node.has_camera) {
            world.add(entity, node.camera);
        }
        add_light(world, entity, node.light);
        entities.push_back(entity);
    }
    // After all nodes, since components may name any of them.
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        add_parts(world, entities[i], scene.nodes[i], offsets);
        add_components(world, entities[i], scene.nodes[i].components, entities, offsets);
    }
    return roots;
}

}  // namespace limn

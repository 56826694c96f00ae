#include "content/load/level/wrinkle_warnings.h"

#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_limit.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/components/wrinkle_response.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr std::string_view kChannelPrefix = "wrinkle.";
constexpr std::size_t kListed = 16;  ///< names in a warning, at most

struct WrinkleCheck {
    const World& world;
    const Assets& assets;
    std::vector<SceneWarning>& warnings;

    void warn(Entity entity, std::string_view what) {
        warnings.push_back({fmt::format("{}: {}", label_of(world, entity), what), entity});
    }

    /// Warns if `field` names nothing of the mesh; `known` are the valid names.
    void check_name(
        Entity entity, const MeshData& mesh, const std::string& field, const std::string& name,
        std::string_view what, const std::vector<std::string_view>& known) {
        if (std::ranges::find(known, name) != known.end()) {
            return;
        }
        const std::span<const std::string_view> some(known.data(), std::min(known.size(), kListed));
        const std::string expected = known.empty() ? std::string("one of a mesh that has any")
                                                   : fmt::format(
                                                       "one of {}{}", fmt::join(some, " "),
                                                       some.size() < known.size() ? " ..." : "");
        warn(
            entity, fmt::format(
                        "wrinkle_surface.{}: found \"{}\", no {} of mesh \"{}\"; expected {}",
                        field, name, what, mesh.name, expected));
    }

    void check_surface(Entity entity, const WrinkleSurface& surface, const MeshData& mesh) {
        std::vector<std::string_view> regions;
        for (const VertexRegion& region : mesh.regions) {
            regions.emplace_back(region.name);
        }
        const auto check = [&](const std::string& field, const std::string& name) {
            check_name(entity, mesh, field, name, "region", regions);
        };
        for (std::size_t i = 0; i < surface.regions.size(); ++i) {
            check(fmt::format("regions[{}]", i), surface.regions[i]);
        }
        for (std::size_t i = 0; i < surface.second_regions.size(); ++i) {
            check(fmt::format("second_regions[{}]", i), surface.second_regions[i]);
        }
        for (std::size_t i = 0; i < surface.resting.size(); ++i) {
            check(fmt::format("resting[{}].region", i), surface.resting[i].region);
        }
        if (!surface.resting_shape.empty()) {
            std::vector<std::string_view> shapes;
            for (const MorphTarget& morph : mesh.morphs) {
                shapes.emplace_back(morph.name);
            }
            check_name(entity, mesh, "resting_shape", surface.resting_shape, "shape", shapes);
        }
    }

    /// Every method but strain_view draws folds from the material's map.
    void check_map(Entity entity, const WrinkleSurface& surface, const MeshInstance& instance) {
        if (surface.method == WrinkleMethod::None || surface.method == WrinkleMethod::StrainView) {
            return;
        }
        const std::uint32_t material = instance.material.index;
        const std::uint32_t map = material < assets.materials.size()
                                      ? assets.materials[material].wrinkle_texture.image.index
                                      : kNoAsset;
        if (map >= assets.images.size()) {
            warn(entity, "wrinkle_surface draws nothing unless its material has a wrinkle_texture");
        } else if (surface.method == WrinkleMethod::Sphere) {
            check_slopes(entity, assets.images[map]);
        }
    }

    /// Normals too steep for the fit to the unit sphere (wrinkle.compression.map).
    void check_slopes(Entity entity, const ImageData& map) {
        const std::size_t steep = count_steep_texels(map);
        if (steep > 0) {
            warn(
                entity, fmt::format(
                            "wrinkle map \"{}\": found {} of {} x {} texels with x^2 + y^2 > {}, "
                            "which method sphere flattens by more than 8.76 degrees between its "
                            "extremes; bump draws them as steep as they are",
                            map.name, steep, map.width, map.height, kSteepestWrinkle));
        }
    }

    void check_ladders() {
        world.query<const WrinkleLadder>().each([&](Entity entity, const WrinkleLadder& ladder) {
            if (!(ladder.displaced_from >= ladder.strain_from)
                || !(ladder.strain_from >= ladder.maps_from)) {
                warn(
                    entity, fmt::format(
                                "wrinkle_ladder: found displaced_from {}, strain_from {}, "
                                "maps_from {} px; expected them to fall: below maps_from no "
                                "wrinkles are drawn, whatever the others say",
                                ladder.displaced_from, ladder.strain_from, ladder.maps_from));
            }
        });
    }

    /// Regions for which a face has two answers.
    void check_responses() {
        world.query<const WrinkleResponse>().each(
            [&](Entity entity, const WrinkleResponse& response) {
                std::vector<WrinkleRegion> known;
                for (std::size_t i = 0; i < response.regions.size(); ++i) {
                    const WrinkleRegion region = response.regions[i].region;
                    if (std::ranges::find(known, region) != known.end()) {
                        warn(
                            entity,
                            fmt::format(
                                "wrinkle_response.regions[{}]: found {} again; only the "
                                "first one counts",
                                i,
                                std::string_view(kWrinkleChannels[static_cast<std::size_t>(region)])
                                    .substr(kChannelPrefix.size())));
                    }
                    known.push_back(region);
                }
            });
    }

    /// Images of a face that do not align with each other.
    void check_maps() {
        world.query<const WrinkleMaps>().each([&](Entity entity, const WrinkleMaps& maps) {
            const auto find = [&](ImageId id) {
                return id.index < assets.images.size() ? &assets.images[id.index] : nullptr;
            };
            const ImageData* const base = find(maps.base);
            const std::pair<const char*, ImageId> fields[] = {
                {"stretched", maps.stretched},     {"compressed", maps.compressed},
                {"first_masks", maps.first_masks}, {"second_masks", maps.second_masks},
                {"third_masks", maps.third_masks}, {"target", maps.target}};
            for (const auto& [field, id] : fields) {
                const ImageData* const image = find(id);
                if (base != nullptr && image != nullptr && !have_one_aspect(*image, *base)) {
                    warn(
                        entity, fmt::format(
                                    "wrinkle_maps.{} \"{}\" is {} x {} px; expected the aspect "
                                    "ratio of base \"{}\", {} x {} px: its wrinkles are not drawn",
                                    field, image->name, image->width, image->height, base->name,
                                    base->width, base->height));
                }
            }
        });
    }
};

}  // namespace

void find_wrinkle_warnings(const World& world, std::vector<SceneWarning>& warnings) {
    const auto* const assets = world.find_resource<Assets>();
    if (assets == nullptr) {
        return;
    }
    WrinkleCheck check{world, *assets, warnings};
    world.query<const WrinkleSurface, const MeshInstance>().each(
        [&](Entity entity, const WrinkleSurface& surface, const MeshInstance& instance) {
            if (instance.mesh.index < assets->meshes.size()) {
                check.check_surface(entity, surface, assets->meshes[instance.mesh.index]);
            }
            check.check_map(entity, surface, instance);
        });
    check.check_maps();
    check.check_ladders();
    check.check_responses();
}

}  // namespace limn

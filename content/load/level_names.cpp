#include "content/load/level_names.h"

#include "content/load/asset_lists.h"
#include "content/load/component_json.h"
#include "ecs/base/text.h"
#include "ecs/components/name.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

namespace {

/// Names of one kind in one file; the index of the first counts what stands before.
struct NameList {
    std::vector<std::string_view> names;
    std::uint32_t first = 0;

    [[nodiscard]] std::optional<std::uint32_t> find(std::string_view name) const {
        for (std::uint32_t i = 0; i < names.size(); ++i) {
            if (names[i] == name) {
                return first + i;
            }
        }
        return std::nullopt;
    }
};

class LateNames {
  public:
    explicit LateNames(Level& level) : level_(level) {
        for (const char* const kind :
             {asset_kind<SkeletonId>, asset_kind<SkinId>, asset_kind<ClipId>}) {
            list_names(kind);
        }
        for (std::size_t i = 0; i < level.gltfs.size(); ++i) {
            for (const std::uint32_t entity : level.gltfs[i].entities) {
                scene_of_[entity] = i;
            }
        }
    }

    Status resolve() {
        for (AnyComponent& resource : level_.resources) {
            if (Status status = resolve(resource, resource.info().name, {}); !status) {
                return status;
            }
        }
        if (Status status = resolve(level_.entities, true); !status) {
            return status;
        }
        for (ScriptEvent& event : level_.events.events) {
            for (ScriptAction& action : event.actions) {
                Status status = resolve(action.prefab, false);
                if (status && !action.value.is_empty()) {
                    const bool is_entity = action.entity.generation == prefab_entity(0).generation;
                    status = resolve(
                        action.value, "events: " + action.value.info().name,
                        is_entity ? scene_of(action.entity.index) : std::nullopt);
                }
                if (!status) {
                    return status;
                }
            }
        }
        return Done{};
    }

  private:
    using SceneNumber = std::optional<std::size_t>;

    void list_names(std::string_view kind) {
        std::vector<NameList>& lists = lists_[std::string(kind)];
        lists.resize(level_.scenes.size() + 1);
        std::uint32_t before = 0;
        const auto add = [&](NameList& list, const auto& assets) {
            list.first = before;
            for (const auto& asset : assets) {
                list.names.emplace_back(asset.name);
            }
            before += static_cast<std::uint32_t>(list.names.size());
        };
        visit_asset_list(level_.assets, kind, [&](const auto& assets) { add(lists[0], assets); });
        for (std::size_t i = 0; i < level_.scenes.size(); ++i) {
            const GltfScene& scene = level_.scenes[i];
            if (kind == asset_kind<SkinId>) {
                add(lists[i + 1], scene.skins);
            } else if (kind == asset_kind<ClipId>) {
                add(lists[i + 1], scene.clips);
            } else if (scene.skeleton.joints.empty()) {
                lists[i + 1].first = before;
            } else {
                add(lists[i + 1], std::span(&scene.skeleton, 1));
            }
        }
    }

    [[nodiscard]] SceneNumber scene_of(std::uint32_t entity) const {
        const auto found = scene_of_.find(entity);
        return found == scene_of_.end() ? std::nullopt : std::optional(found->second);
    }

    Status resolve(Prefab& prefab, bool is_level) {
        for (std::uint32_t i = 0; i < prefab.entities.size(); ++i) {
            std::vector<AnyComponent>& components = prefab.entities[i].components;
            const AnyComponent* name = nullptr;
            for (const AnyComponent& component : components) {
                name = &component.info() == &component_info<Name>() ? &component : name;
            }
            for (AnyComponent& component : components) {
                const std::string place = fmt::format(
                    "entity {}: {}",
                    name != nullptr ? in_quotes(name->as<Name>().text) : std::to_string(i),
                    component.info().name);
                Status status = resolve(component, place, is_level ? scene_of(i) : std::nullopt);
                if (!status) {
                    return status;
                }
            }
        }
        return Done{};
    }

    Status resolve(AnyComponent& component, std::string_view place, SceneNumber own) {
        Status result = Done{};
        for_each_asset(
            component.info().fields, component.data(),
            [&](std::string_view kind, std::uint32_t& index) {
                const auto lists = lists_.find(std::string(kind));
                if (lists == lists_.end() || index == kNoAsset || !result) {
                    return;
                }
                const std::string& name = level_.late_names[index];
                const std::optional<std::uint32_t> found = find(lists->second, name, own);
                if (found) {
                    index = *found;
                    return;
                }
                std::vector<std::string_view> known;
                for (const NameList& list : lists->second) {
                    known.insert(known.end(), list.names.begin(), list.names.end());
                }
                result = fail(
                    "{}: {}: found the {} {}, expected one of a glTF file or a made mesh{}",
                    level_.file, place, kind, in_quotes(name), did_you_mean(name, known));
            });
        return result;
    }

    static std::optional<std::uint32_t>
    find(const std::vector<NameList>& lists, std::string_view name, SceneNumber own) {
        std::optional<std::uint32_t> found = own ? lists[*own + 1].find(name) : std::nullopt;
        for (std::size_t i = 0; i < lists.size() && !found; ++i) {
            found = lists[i].find(name);
        }
        return found;
    }

    Level& level_;
    std::unordered_map<std::string, std::vector<NameList>> lists_;  ///< the level's own first
    std::unordered_map<std::uint32_t, std::size_t> scene_of_;       ///< entity -> of `scenes`
};

}  // namespace

Status resolve_late_names(Level& level) {
    return level.late_names.empty() ? Status(Done{}) : LateNames(level).resolve();
}

}  // namespace limn

#include "content/load/level/level_names.h"

#include "content/load/asset_lists.h"
#include "content/load/files/error_list.h"
#include "content/load/level/component_json.h"
#include "ecs/base/text.h"
#include "ecs/components/name.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

namespace {

/// Names of one kind in one file; `first` is the number of names in the lists before it.
struct LevelNameList {
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

class DeferredNames {
  public:
    explicit DeferredNames(Level& level) : level_(level) {
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
            resolve(resource, resource.info().name, {});
        }
        for (MotionGraphData& graph : level_.motion_graphs) {
            resolve(component_info<MotionGraphData>(), &graph, "motion_graphs." + graph.name, {});
        }
        resolve(level_.entities, true);
        for (NodeChange& change : level_.node_changes) {
            if (!change.set.value.is_empty()) {
                resolve(
                    change.set.value, fmt::format("nodes.{}.{}", change.node, change.info->name),
                    scene_of(change.entity));
            }
        }
        for (ScriptEvent& event : level_.events.events) {
            for (ScriptAction& action : event.actions) {
                resolve(action.prefab, false);
                if (!action.value.is_empty()) {
                    const bool is_entity = action.entity.generation == prefab_entity(0).generation;
                    resolve(
                        action.value, "events: " + action.value.info().name,
                        is_entity ? scene_of(action.entity.index) : std::nullopt);
                }
            }
        }
        return errors_.status();
    }

  private:
    using SceneNumber = std::optional<std::size_t>;

    void list_names(std::string_view kind) {
        std::vector<LevelNameList>& lists = lists_[std::string(kind)];
        lists.resize(level_.scenes.size() + 1);
        std::uint32_t count = 0;
        const auto add = [&](LevelNameList& list, std::vector<std::string_view> names) {
            list.first = count;
            count += static_cast<std::uint32_t>(names.size());
            list.names = std::move(names);
        };
        add(lists[0], asset_names(level_.assets, kind));
        for (std::size_t i = 0; i < level_.scenes.size(); ++i) {
            add(lists[i + 1], asset_names(list_assets(level_.scenes[i]), kind));
        }
    }

    [[nodiscard]] SceneNumber scene_of(std::uint32_t entity) const {
        const auto found = scene_of_.find(entity);
        return found == scene_of_.end() ? std::nullopt : std::optional(found->second);
    }

    void resolve(Prefab& prefab, bool is_level) {
        for (std::uint32_t i = 0; i < prefab.entities.size(); ++i) {
            std::vector<AnyComponent>& components = prefab.entities[i].components;
            const auto* const name = find_in<Name>(components);
            for (AnyComponent& component : components) {
                const std::string location = fmt::format(
                    "entity {}: {}", name != nullptr ? in_quotes(name->text) : std::to_string(i),
                    component.info().name);
                resolve(component, location, is_level ? scene_of(i) : std::nullopt);
            }
        }
    }

    void resolve(AnyComponent& component, std::string_view location, SceneNumber own) {
        resolve(component.info(), component.data(), location, own);
    }

    void
    resolve(const ComponentInfo& info, void* object, std::string_view location, SceneNumber own) {
        for_each_asset(info.fields, object, [&](std::string_view kind, std::uint32_t& index) {
            const auto lists = lists_.find(std::string(kind));
            if (lists == lists_.end() || index == kNoAsset) {
                return;
            }
            const auto& [name, at] = level_.deferred_names[index];
            const std::optional<std::uint32_t> found = find(lists->second, name, own);
            if (found) {
                index = *found;
                return;
            }
            const std::vector<std::string_view> known = known_names(lists->second, own);
            errors_.keep(fail(
                "{}: {}: found the {} {}, expected {}{}", location_text(level_.file, at), location,
                kind, in_quotes(name),
                known.empty() ? "one of a glTF file or a generated mesh, which have none"
                              : "one of " + some_of(known),
                did_you_mean(name, known)));
        });
    }

    /// Those of the entity's own file, or else all.
    static std::vector<std::string_view>
    known_names(const std::vector<LevelNameList>& lists, SceneNumber own) {
        if (own && !lists[*own + 1].names.empty()) {
            return lists[*own + 1].names;
        }
        std::vector<std::string_view> known;
        for (const LevelNameList& list : lists) {
            known.insert(known.end(), list.names.begin(), list.names.end());
        }
        return known;
    }

    static std::string some_of(std::span<const std::string_view> names) {
        constexpr std::size_t kShown = 8;
        std::string text = join_text(names.first(std::min(names.size(), kShown)), ", ");
        return names.size() > kShown ? text + " ..." : text;
    }

    static std::optional<std::uint32_t>
    find(const std::vector<LevelNameList>& lists, std::string_view name, SceneNumber own) {
        std::optional<std::uint32_t> found = own ? lists[*own + 1].find(name) : std::nullopt;
        for (std::size_t i = 0; i < lists.size() && !found; ++i) {
            found = lists[i].find(name);
        }
        return found;
    }

    Level& level_;
    ErrorList errors_{level_.file};
    std::unordered_map<std::string, std::vector<LevelNameList>> lists_;  ///< the level's own first
    std::unordered_map<std::uint32_t, std::size_t> scene_of_;            ///< entity -> of `scenes`
};

}  // namespace

Status resolve_deferred_names(Level& level) {
    return level.deferred_names.empty() ? Status(Done{}) : DeferredNames(level).resolve();
}

}  // namespace limn

#include "content/load/level/level_show.h"

#include "content/load/level/component_json.h"
#include "content/load/level/level_patch.h"
#include "ecs/base/text.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/lens_flare.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

constexpr double kMaxShowTime = 3600;  // [s]
constexpr std::string_view kShowKeys[] = {"technique", "text",   "set",  "off",
                                          "time",      "camera", "equal"};

Status
read_text(const JsonValue& json, const char* key, const JsonLocation& location, std::string& text) {
    LIMN_TRY(expect(json[key], JsonKind::String, location_in(location, key), "a string"));
    text = json[key].text;
    return Done{};
}

Status
read_patch(const JsonValue& json, const char* key, const JsonLocation& location, JsonValue& patch) {
    if (const JsonValue* const value = json.find(key)) {
        LIMN_TRY(
            expect(*value, JsonKind::Object, location_in(location, key), "a patch (an object)"));
        patch = *value;
    }
    return Done{};
}

Status read_camera(const JsonValue& json, const JsonLocation& location, LevelShow& show) {
    if (json.kind == JsonKind::String) {
        show.camera_name = json.text;
        return Done{};
    }
    return read_struct(json, show.camera.emplace(), location, {});
}

Result<LevelShow> read_show(const JsonValue& json, const JsonLocation& location) {
    LIMN_TRY(expect_keys(json, location, kShowKeys, "a show (an object)"));
    LevelShow show;
    LIMN_TRY(read_text(json, "technique", location, show.technique));
    LIMN_TRY(read_text(json, "text", location, show.text));
    LIMN_TRY(read_patch(json, "set", location, show.set));
    LIMN_TRY(read_patch(json, "off", location, show.off));
    if (show.set.kind == JsonKind::Null && show.off.kind == JsonKind::Null) {
        return unexpected(json, location, "\"set\", \"off\" or both");
    }
    if (const JsonValue* const time = json.find("time")) {
        show.time =
            LIMN_TRY(expect_number(*time, 0, kMaxShowTime, location_in(location, "time"), "s"));
    }
    if (const JsonValue* const camera = json.find("camera")) {
        LIMN_TRY(read_camera(*camera, location_in(location, "camera"), show));
    }
    if (const JsonValue* const equal = json.find("equal")) {
        LIMN_TRY(expect(*equal, JsonKind::Bool, location_in(location, "equal"), "true or false"));
        show.equal = equal->truth;
    }
    return show;
}

}  // namespace

std::vector<LevelShow>
read_shows(const JsonValue& level, std::string_view file, ErrorList& errors) {
    std::vector<LevelShow> shows;
    const JsonValue& list = level["shows"];
    for (std::size_t i = 0; i < list.items.size() && errors.has_room(); ++i) {
        const JsonLocation location{file, fmt::format("shows[{}]", i)};
        Result<LevelShow> show = read_show(list.items[i], location);
        if (!show) {
            errors.keep(show.error());
            continue;
        }
        const bool is_new = std::none_of(shows.begin(), shows.end(), [&](const LevelShow& other) {
            return other.technique == show->technique;
        });
        if (!is_new) {
            errors.keep(error_at(
                location, list.items[i].at, "a second show of " + show->technique,
                "one of each technique"));
            continue;
        }
        shows.push_back(*std::move(show));
    }
    return shows;
}

Result<std::vector<LevelShow>> read_shows(const JsonValue& level, std::string_view file) {
    ErrorList errors{std::string(file)};
    std::vector<LevelShow> shows = read_shows(level, file, errors);
    LIMN_TRY(errors.status());
    return shows;
}

Status apply_show(const LevelShow& show, bool off, std::string_view file, JsonValue& level) {
    const JsonLocation location{file, "show " + show.technique};
    const bool has_off = show.off.kind == JsonKind::Object;
    if (show.set.kind == JsonKind::Object && (!off || has_off)) {
        LIMN_TRY(patch_level(level, show.set, location_in(location, "set")));
    }
    if (off && has_off) {
        LIMN_TRY(patch_level(level, show.off, location_in(location, "off")));
    }
    return Done{};
}

Result<std::optional<LevelShow>>
choose_show(const ShowChoice& choice, std::string_view file, JsonValue& level) {
    if (choice.technique.empty()) {
        return std::optional<LevelShow>();
    }
    std::vector<LevelShow> shows = LIMN_TRY(read_shows(level, file));
    std::vector<std::string_view> names;
    for (LevelShow& show : shows) {
        if (show.technique == choice.technique) {
            LIMN_TRY(apply_show(show, choice.off, file, level));
            return std::optional(std::move(show));
        }
        names.emplace_back(show.technique);
    }
    return fail(
        "{}: found no show of {}, expected one of the level's{}", file, choice.technique,
        did_you_mean(choice.technique, names));
}

Result<Entity> place_show_camera(World& world, const LevelShow& show, Entity camera) {
    Entity chosen;
    if (show.camera) {
        const Camera* const own = std::as_const(world).find<Camera>(camera);
        Camera lens = own != nullptr ? *own : Camera{};
        lens.fov_y = show.camera->fov_y > 0 ? show.camera->fov_y : lens.fov_y;
        const Quat rotation = look_along(show.camera->look_at - show.camera->position);
        chosen = world.create(
            Name{"show"}, Transform{.position = show.camera->position, .rotation = rotation}, lens);
        if (const Lens* const focus = std::as_const(world).find<Lens>(camera)) {
            world.add(chosen, Lens(*focus));
        }
        if (const LensFlare* const flare = std::as_const(world).find<LensFlare>(camera)) {
            world.add(chosen, LensFlare(*flare));
        }
    } else if (!show.camera_name.empty()) {
        world.query<const Name, const Camera>().each(
            [&](Entity entity, const Name& name, const Camera&) {
                chosen = name.text == show.camera_name ? entity : chosen;
            });
        if (chosen.is_null()) {
            return fail(
                "show {}: found no camera \"{}\", expected the name of one in the level",
                show.technique, show.camera_name);
        }
    } else {
        return camera;
    }
    world.query<Camera>().each(
        [&](Entity entity, Camera& other) { other.active = entity == chosen; });
    return chosen;
}

Result<std::vector<FoundShow>> list_shows() {
    std::vector<FoundShow> all;
    for (const LevelEntry& level : list_levels()) {
        const JsonValue json = LIMN_TRY(load_json(level.path));
        for (LevelShow& show : LIMN_TRY(read_shows(json, level.path))) {
            all.push_back({level, std::move(show)});
        }
    }
    return all;
}

Result<FoundShow> find_show(std::string_view technique) {
    std::vector<FoundShow> all = LIMN_TRY(list_shows());
    std::vector<std::string_view> names;
    for (FoundShow& found : all) {
        if (found.show.technique == technique) {
            return std::move(found);
        }
        names.emplace_back(found.show.technique);
    }
    return fail(
        "found no level that shows {}, expected an id{}; `limn shows {}` searches by name; of a "
        "level of your own, `limn play FILE --show {}`",
        technique, did_you_mean(technique, names), technique, technique);
}

}  // namespace limn

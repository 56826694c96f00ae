// Every show of every level, on and off: the images differ, or for methods that must agree, do not.

#include "content/app/commands/render_command.h"
#include "content/app/commands/render_frames.h"
#include "content/app/commands/stage.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_show.h"
#include "ecs/components/env_probe.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"
#include "tests/app/level_fixture.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace limn::level_shows_test {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 90;
constexpr int kVisible = 8;              // of 255: a visible difference in a channel
constexpr double kMinDifferent = 0.002;  // of the pixels that must differ so much
constexpr double kMaxDifferent = 0.001;  // of the pixels that may, where methods must agree

bool is_about_probes(const LevelShow& show) {
    return (write_json(show.set) + write_json(show.off)).find("env_probe") != std::string::npos;
}

/// Takes the environment probes away, whose six faces are half the work of an image, where a show
/// is not about them.
void remove_probes(World& world, const LevelShow& show) {
    if (is_about_probes(show)) {
        return;
    }
    std::vector<Entity> probes;
    world.query<const EnvProbe>().each(
        [&](Entity entity, const EnvProbe&) { probes.push_back(entity); });
    for (const Entity probe : probes) {
        world.remove<EnvProbe>(probe);
    }
}

/// The show's image as `limn render` makes it.
gpu::ByteImage draw_show(const FoundShow& found, bool off) {
    const std::unique_ptr<Stage> stage =
        test::open_level(found.level.path, {.technique = found.show.technique, .off = off});
    remove_probes(stage->world, found.show);
    RenderOptions options;
    options.size = {kWidth, kHeight};
    options.edge_samples = 1;
    const FrameOutput frame = draw_still(
        *test::level_renderer().renderer, *stage, stage->scene.camera, options, found.show.time);
    return gpu::read_bytes(*frame.display);
}

/// All that an image depends on: `off` is patched on top of `set`; without it, off is the level as
/// it is.
std::string image_key(const FoundShow& found, bool off) {
    const LevelShow& show = found.show;
    const bool has_off = show.off.kind == JsonKind::Object;
    std::string key = fmt::format(
        "{} {} {} {} {} {}", found.level.name, !off || has_off ? write_json(show.set) : "null",
        off && has_off ? write_json(show.off) : "null", show.time, is_about_probes(show),
        show.camera_name);
    if (show.camera) {
        const ShowCamera& at = *show.camera;
        key += fmt::format(
            " {} {} {} {} {} {} {}", at.position.x, at.position.y, at.position.z, at.look_at.x,
            at.look_at.y, at.look_at.z, at.fov_y);
    }
    return key;
}

/// Those of draw_show() that several shows share are drawn once.
class ShowImages {
  public:
    const gpu::ByteImage& of(const FoundShow& found, bool off) {
        const std::string key = image_key(found, off);
        const auto drawn = images_.find(key);
        return drawn != images_.end() ? drawn->second
                                      : images_.emplace(key, draw_show(found, off)).first->second;
    }

  private:
    std::map<std::string, gpu::ByteImage> images_;
};

/// Fraction of the pixels with a visible difference.
double different_fraction(const gpu::ByteImage& a, const gpu::ByteImage& b) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    const auto channels = static_cast<std::size_t>(a.channels);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += channels) {
        int largest = 0;
        for (std::size_t c = 0; c < std::min<std::size_t>(channels, 3); ++c) {
            largest = std::max(largest, std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]}));
        }
        different += largest >= kVisible ? 1 : 0;
    }
    return static_cast<double>(different) * static_cast<double>(channels)
           / static_cast<double>(a.pixels.size());
}

}  // namespace

TEST_CASE("shows: each changes the image where it is on, or nothing where methods must agree") {
    const Result<std::vector<FoundShow>> shows = list_shows();
    REQUIRE_MESSAGE(shows.ok(), (shows ? std::string() : shows.error().message));
    REQUIRE_FALSE(shows->empty());
    ShowImages images;
    for (const FoundShow& found : *shows) {
        CAPTURE(found.level.name);
        CAPTURE(found.show.technique);
        const double fraction = different_fraction(images.of(found, false), images.of(found, true));
        if (found.show.equal) {
            CHECK(fraction <= kMaxDifferent);
        } else {
            CHECK(fraction >= kMinDifferent);
        }
    }
}

TEST_CASE("shows: every technique of a level has a row in TECHNIQUES.md that names the level") {
    const Result<std::vector<FoundShow>> shows = list_shows();
    REQUIRE(shows.ok());
    std::ifstream page(std::string(LIMN_SOURCE_DIR) + "/TECHNIQUES.md");
    std::map<std::string, std::string> shown_by;
    for (std::string line; std::getline(page, line);) {
        const std::size_t end = line.find(" |", 2);
        const std::size_t last = line.rfind('|', line.size() - 2);
        if (line.starts_with("| ") && end != std::string::npos && last != std::string::npos) {
            shown_by[line.substr(2, end - 2)] = line.substr(last);
        }
    }
    for (const FoundShow& found : *shows) {
        CAPTURE(found.show.technique);
        const std::string level = fmt::format("`{}`", found.level.name);
        CHECK(shown_by[found.show.technique].find(level) != std::string::npos);
    }
}

}  // namespace limn::level_shows_test

#include "content/app/commands/render_record.h"

#include "content/app/commands/render_command.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/hash.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

namespace limn {

std::string describe_render(const RenderOptions& options) {
    std::string text;
    const auto add = [&text](const char* name, const std::string& value) {
        text += fmt::format("{}: {}\n", name, value);
    };
    add("version", LIMN_VERSION);
    add("scene", options.scene);
    if (const auto bytes = read_file(options.scene)) {  // a file, not the name of a level
        add("file", fmt::format("{:016x}", hash_bytes(*bytes)));
    }
    add("size", fmt::format("{}x{}", options.size.x, options.size.y));
    add("fps", fmt::format("{}", options.fps));
    add("seed", options.seed ? fmt::format("{}", *options.seed) : "of the level");
    add("spp", fmt::format("{}", options.samples));
    if (options.average) {
        add("average", *options.average == SampleMean::Light ? "light" : "displayed");
    }
    add("camera", options.camera);
    add("profile",
        options.profile ? fmt::format("{}", static_cast<int>(*options.profile)) : "of the device");
    if (!options.renderer.empty()) {
        add("renderer", options.renderer);
    }
    add("show", options.show.technique + (options.show.off ? " off" : ""));
    add("model",
        fmt::format(
            "{} {} {}", options.model.backdrop, options.model.turntable, options.model.variant));
    for (const Assignment& set : options.assignments) {
        add("set", set.path + "=" + set.value);
    }
    return text;
}

Status claim_frames(const std::string& path, const std::string& description) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return write_file(path, description);
    }
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    std::istringstream old(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::istringstream now(description);
    for (;;) {
        std::string found;
        std::string expected;
        const bool more = static_cast<bool>(std::getline(old, found));
        if (!std::getline(now, expected) && !more) {
            return Done{};
        }
        if (found != expected) {
            return fail(
                "{}: found frames of another render ({}), expected {}; remove the folder to begin "
                "anew",
                path, found.empty() ? "nothing" : found, expected.empty() ? "nothing" : expected);
        }
    }
}

}  // namespace limn

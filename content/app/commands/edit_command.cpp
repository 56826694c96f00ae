#include "content/app/commands/edit_command.h"

#include "content/app/commands/stage.h"
#include "content/app/panels/edit_json.h"
#include "content/app/panels/edit_save.h"
#include "content/app/panels/edit_script.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>

namespace limn {
namespace {

struct EditLine {
    std::string text;
    std::string place;  ///< "arrange.txt:3", for messages
};

Result<std::vector<EditLine>> read_lines(const EditOptions& options) {
    std::vector<EditLine> lines;
    if (!options.script.empty()) {
        const std::vector<std::byte> bytes = LIMN_TRY(read_file(options.script));
        const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
        std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
        for (int number = 1; begin < text.size(); ++number) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            lines.push_back(
                {text.substr(begin, end - begin), fmt::format("{}:{}", options.script, number)});
            begin = end + 1;
        }
    }
    for (const std::string& line : options.lines) {
        lines.push_back({line, '"' + line + '"'});
    }
    return lines;
}

}  // namespace

Status run_edit(const EditOptions& options) {
    const std::vector<EditLine> lines = LIMN_TRY(read_lines(options));
    if (lines.empty()) {
        return fail("limn edit: found no edits, expected some, or --script");
    }
    const std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(options.scene));
    const LoadedScene& scene = stage->scene;
    EditScript script(PlacedLevel{scene.model ? "" : scene.path, scene.fields.entities});
    for (const EditLine& line : lines) {
        const Result<std::string> done = script.run(stage->world, line.text);
        if (!done) {
            return fail("{}: {}", line.place, done.error().message);
        }
        if (!done->empty() && !options.out.empty()) {
            fmt::print("{}\n", *done);
        }
    }
    if (options.out.empty()) {
        fmt::print("{}\n", edits_as_json(stage->world, script.undo_stack().done()));
        return Done{};
    }
    const EditedLevel level = LIMN_TRY(edited_level(
        stage->scene.path, options.out, stage->world, script.undo_stack().done(),
        stage->scene.fields.entities));
    for (const std::string& what : level.left_out) {
        log_warn("{}: saved without {}", options.out, what);
    }
    LIMN_TRY(write_file(options.out, level.text));
    fmt::print("{}\n", options.out);
    return Done{};
}

}  // namespace limn

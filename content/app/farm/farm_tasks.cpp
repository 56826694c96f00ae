#include "content/app/farm/farm_tasks.h"

#include "content/app/farm/child_process.h"
#include "content/load/level/level_list.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace limn {
namespace {

Result<std::vector<std::string>> names_of(const std::string& command) {
    std::vector<std::string> names;
    if (command == "bench") {
        for (const LevelEntry& level : list_levels()) {
            names.push_back(level.name);
        }
        return names;
    }
    std::istringstream lines(LIMN_TRY(run_program({program_path(), "quality", "--list"})));
    for (std::string name; std::getline(lines, name);) {
        names.push_back(name);
    }
    return names;
}

}  // namespace

Status add_tasks(FarmJob& job, const std::vector<std::string>& words) {
    const std::string& command = words.front();
    if (command != "quality" && command != "bench") {
        return fail("found command \"{}\", expected quality or bench", command);
    }
    const auto all = std::ranges::find(words, "--all");
    if (all == words.end()) {
        job.tasks.push_back(words);
    } else {
        for (const std::string& name : LIMN_TRY(names_of(command))) {
            std::vector<std::string> task = {command, name};
            std::ranges::copy_if(
                words.begin() + 1, words.end(), std::back_inserter(task),
                [](const std::string& word) { return word != "--all"; });
            job.tasks.push_back(std::move(task));
        }
    }
    job.name = "%05d.json";
    for (int i = 0; i < static_cast<int>(job.tasks.size()); ++i) {
        job.frames.push_back(i);
    }
    return Done{};
}

}  // namespace limn

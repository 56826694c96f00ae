#include "content/app/quality_command.h"

#include "ecs/base/text.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <unistd.h>

namespace limn {

Status run_quality(std::vector<std::string> arguments) {
    std::error_code ignored;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::string program = self.parent_path() / "limn-quality";
    arguments.insert(arguments.begin(), program);
    std::vector<char*> words;
    for (std::string& argument : arguments) {
        words.push_back(argument.data());
    }
    words.push_back(nullptr);
    execv(program.c_str(), words.data());
    const int error = errno;
    if (error == ENOENT) {
        return fail(
            "limn quality: found no program {}, build it with: cmake --build --preset release "
            "--target limn-quality",
            program);
    }
    return fail("limn quality: {}: {}", program, std::strerror(error));
}

}  // namespace limn

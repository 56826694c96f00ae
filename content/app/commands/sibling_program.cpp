#include "content/app/commands/sibling_program.h"

#include "ecs/base/text.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <unistd.h>

namespace limn {

Status
run_sibling(std::string_view command, const std::string& name, std::vector<std::string> arguments) {
    std::error_code ignored;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::string program = self.parent_path() / name;
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
            "{}: found no program {}, build it with: cmake --build --preset release --target {}",
            command, program, name);
    }
    return fail("{}: {}: {}", command, program, std::strerror(error));
}

}  // namespace limn

#pragma once

#include "ecs/base/log.h"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

/// The path of a file under ../shared, or nothing: then the line "SKIP: ..." is printed and the
/// test returns. No other reason to skip is accepted by .ci/run.
inline std::optional<std::string> shared_file(const std::string& relative) {
    const std::filesystem::path path =
        std::filesystem::path(LIMN_SOURCE_DIR) / ".." / "shared" / relative;
    if (!std::filesystem::exists(path)) {
        std::printf("SKIP: ../shared/%s is not here\n", relative.c_str());
        return std::nullopt;
    }
    return path.lexically_normal().string();
}

/// A real model or other asset.
inline std::optional<std::string> shared_asset(const std::string& relative) {
    return shared_file("assets/" + relative);
}

/// A small input rebuilt from a public bug report; expected.txt beside it says what is right.
inline std::optional<std::string> shared_report(const std::string& relative) {
    return shared_file("reports/" + relative);
}

/// Log messages that `action` leaves.
template <typename Action>
std::vector<std::string> messages_of(Action&& action) {
    static std::vector<std::string> messages;
    messages.clear();
    set_log_sink([](LogLevel, std::string_view message) { messages.emplace_back(message); });
    action();
    set_log_sink(nullptr);
    return messages;
}

/// A folder for a test's files, empty at the start and gone at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "limn-test-XXXXXX").string();
        if (mkdtemp(pattern.data()) != nullptr) {
            path_ = pattern;
        }
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (path_ / name).string();
    }
    [[nodiscard]] std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

}  // namespace limn::test

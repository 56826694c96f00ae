#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <utility>

namespace limn {

// The small JSON files of a job: whatever is wrong with one, reading it neither throws nor ends the
// program.

using FarmJson = nlohmann::ordered_json;

/// The member of that name, or `fallback` where there is none, or one of another type.
template <typename T>
[[nodiscard]] T member_or(const FarmJson& object, const char* name, T fallback) {
    const auto member = object.find(name);
    if (member == object.end()) {
        return fallback;
    }
    try {
        return member->get<T>();
    } catch (const FarmJson::exception&) {
        return fallback;
    }
}

/// An empty object where the file cannot be read, or is none.
[[nodiscard]] FarmJson read_farm_json(const std::string& path);

/// The text of JSON; bytes that are not UTF-8, as of file names, are replaced.
[[nodiscard]] inline std::string farm_json_text(const FarmJson& json, int indent = -1) {
    return json.dump(indent, ' ', false, FarmJson::error_handler_t::replace) + "\n";
}

}  // namespace limn

#pragma once

#include <string>
#include <string_view>

namespace limn {

struct ComponentInfo;

/// Whether the component or resource is internal state of systems, which levels do not set.
[[nodiscard]] bool is_internal(const ComponentInfo& info);

/// A hint to append to an error about an unknown name in a level: ` ("environment" is a resource:
/// it belongs in "resources")`; else `did_you_mean`, and if that is empty, ` ("position" is a field
/// of transform)`.
[[nodiscard]] std::string where_it_belongs(std::string_view name, const std::string& did_you_mean);

}  // namespace limn

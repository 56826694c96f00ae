#include "content/load/files/load_warnings.h"

#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <algorithm>

namespace limn {

Status report_load_warnings(
    const std::string& file, std::span<const std::string> warnings, const LoadOptions& options) {
    const std::size_t shown = std::min(warnings.size(), options.max_warnings);
    std::string refused;
    const auto report = [&](std::string_view line) {
        if (options.strict) {
            refused += (refused.empty() ? "" : "\n") + std::string(line);
        } else {
            log_warn("{}", line);
        }
    };
    for (const std::string& warning : warnings.first(shown)) {
        report(warning);
    }
    if (shown < warnings.size()) {
        report(format_text("{}: {} more warnings", file, warnings.size() - shown));
    }
    if (!refused.empty()) {
        return Error{refused};
    }
    return Done{};
}

}  // namespace limn

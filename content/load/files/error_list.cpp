#include "content/load/files/error_list.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

namespace limn {

void ErrorList::keep(const Status& status) {
    if (status) {
        return;
    }
    ++count_;
    const std::string& message = status.error().message;
    const std::size_t location_end = message.find(": ", file_.size());
    if (has_room() && locations_.insert(message.substr(0, location_end)).second
        && lines_.size() < kShownErrors) {
        lines_.push_back(message);
    }
}

Status ErrorList::status() const {
    if (empty()) {
        return Done{};
    }
    std::string lines = join_text(lines_, "\n");
    if (const std::size_t more = locations_.size() - lines_.size(); more > 0) {
        lines += fmt::format("\n{}: and {}{} more", file_, has_room() ? "" : "at least ", more);
    }
    return Error{std::move(lines)};
}

}  // namespace limn

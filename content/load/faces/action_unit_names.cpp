#include "content/load/faces/action_unit_names.h"

#include "content/load/faces/ict_facekit.h"
#include "content/load/faces/makehuman.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace limn {

namespace {

struct Side {
    std::string_view suffix;
    std::string_view side;
};
constexpr Side kUnitSides[] = {
    {"_L", "_L"},     {"_R", "_R"}, {"Left", "_L"}, {"Right", "_R"}, {"_left", "_L"},
    {"_right", "_R"}, {"_l", "_L"}, {"_r", "_R"},   {"left", "_L"},  {"right", "_R"},
};

/// "mouthSmile" and "_L".
std::pair<std::string_view, std::string_view> split_side(std::string_view name) {
    for (const Side& side : kUnitSides) {
        if (name.size() > side.suffix.size() && name.ends_with(side.suffix)) {
            return {name.substr(0, name.size() - side.suffix.size()), side.side};
        }
    }
    return {name, ""};
}

bool is_unit(std::string_view name) {
    return name.size() >= 3 && name.size() <= 4 && (name[0] == 'A' || name[0] == 'a')
           && (name[1] == 'U' || name[1] == 'u')
           && std::all_of(name.begin() + 2, name.end(), [](char c) {
                  return std::isdigit(static_cast<unsigned char>(c)) != 0;
              });
}

}  // namespace

std::string find_action_unit(std::string_view name) {
    if (const std::size_t dot = name.rfind('.'); dot != std::string_view::npos) {
        name = name.substr(dot + 1);
    }
    if (std::string unit = makehuman_action_unit(name); !unit.empty()) {
        return unit;
    }
    if (std::string unit = ict_action_unit(name); !unit.empty()) {
        return unit;
    }
    const auto [base, side] = split_side(name);
    if (is_unit(base)) {
        return "AU" + std::string(base.substr(2)) + std::string(side);
    }
    return ict_action_unit(std::string(base) + std::string(side));
}

}  // namespace limn

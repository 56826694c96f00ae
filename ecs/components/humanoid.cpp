#include "ecs/components/humanoid.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

namespace {

enum class Side : std::uint8_t { None, Left, Right };

/// A joint's name without side, prefix and separators: "upleg" of "mixamorig:LeftUpLeg".
struct PlainName {
    Side side = Side::None;
    std::string name;
};

std::string lower_letters_and_digits(std::string_view text) {
    std::string plain;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0) {
            plain += static_cast<char>(std::tolower(byte));
        }
    }
    return plain;
}

bool is_separator(char c) {
    return c == '_' || c == '.' || c == '-' || c == ' ';
}

/// "L" at the end, or alone between separators: "thigh.L", "J_Bip_L_UpperLeg", "l_thigh".
std::optional<std::pair<Side, std::string>> take_side_letter(std::string_view name) {
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(name[i])));
        const bool begins = i == 0 || is_separator(name[i - 1]);
        const bool ends = i + 1 == name.size() || is_separator(name[i + 1]);
        if (begins && ends && name.size() > 1 && (letter == 'L' || letter == 'R')) {
            std::string rest(name.substr(0, i));
            rest += name.substr(i + 1);
            return std::pair(letter == 'L' ? Side::Left : Side::Right, rest);
        }
    }
    return std::nullopt;
}

PlainName plain_name(std::string_view name) {
    if (name.starts_with("__")) {
        return {};  // a helper joint between two parts, in BVH files of MakeHuman
    }
    if (const std::size_t colon = name.rfind(':'); colon != std::string_view::npos) {
        name.remove_prefix(colon + 1);
    }
    PlainName plain;
    std::string rest(name);
    if (auto letter = take_side_letter(name)) {
        plain.side = letter->first;
        rest = letter->second;
    }
    plain.name = lower_letters_and_digits(rest);
    for (const std::string_view prefix : {"jbip", "bip01", "bip001"}) {
        if (plain.name.starts_with(prefix)) {
            plain.name.erase(0, prefix.size());
        }
    }
    for (const auto& [word, side] :
         {std::pair("left", Side::Left), std::pair("right", Side::Right)}) {
        if (const std::size_t at = plain.name.find(word);
            plain.side == Side::None && at != std::string::npos) {
            plain.side = side;
            plain.name.erase(at, std::string_view(word).size());
        }
    }
    if (plain.side == Side::None && plain.name.starts_with("c") && plain.name.size() > 3
        && name.starts_with("J_Bip_C")) {
        plain.name.erase(0, 1);  // VRM marks the middle of the body by C
    }
    return plain;
}

/// Names of a part, the most telling first. What several parts may be called comes last.
std::span<const std::string_view> names_of(std::size_t limb_part) {
    using Names = std::vector<std::string_view>;
    static const std::array<Names, 8> names = {
        Names{"clavicle", "collar", "collarbone", "shoulder"},
        Names{"upperarm", "upperarm01", "uparm", "arm", "shoulder"},
        Names{"forearm", "lowerarm", "lowerarm01", "loarm", "elbow"},
        Names{"hand", "wrist"},
        Names{"thigh", "upleg", "upperleg", "upperleg01", "hip"},
        Names{"shin", "calf", "lowerleg", "lowerleg01", "loleg", "leg", "knee"},
        Names{"foot", "ankle"},
        Names{"toes", "toe", "toebase", "ball", "toe11"},
    };
    return names[limb_part];
}

std::span<const std::string_view> middle_names_of(BodyPart part) {
    using Names = std::vector<std::string_view>;
    static const std::array<Names, 5> names = {
        Names{"hips", "pelvis", "hip", "root"},
        Names{"spine", "spine1", "spine01", "lowback", "abdomen", "torso", "back"},
        Names{"upperchest", "chest", "thorax", "spine3", "spine2", "upback", "spine1"},
        Names{"neck", "neck1", "neck01"},
        Names{"head"},
    };
    return names[static_cast<std::size_t>(part)];
}

class PartFinder {
  public:
    explicit PartFinder(const SkeletonData& skeleton) {
        for (const std::string& joint : skeleton.joints) {
            names_.push_back(plain_name(joint));
        }
        found_.joints.fill(BodyJoints::kNoJoint);
    }

    void find(BodyPart part, Side side, std::span<const std::string_view> candidates) {
        for (const std::string_view candidate : candidates) {
            for (std::size_t i = 0; i < names_.size(); ++i) {
                if (names_[i].side == side && names_[i].name == candidate && !is_taken(i)) {
                    found_.joints[static_cast<std::size_t>(part)] = static_cast<std::uint16_t>(i);
                    return;
                }
            }
        }
    }

    void set(BodyPart part, std::uint16_t joint) {
        found_.joints[static_cast<std::size_t>(part)] = joint;
    }

    [[nodiscard]] const BodyJoints& found() const { return found_; }

  private:
    [[nodiscard]] bool is_taken(std::size_t joint) const {
        return std::find(found_.joints.begin(), found_.joints.end(), joint) != found_.joints.end();
    }

    std::vector<PlainName> names_;
    BodyJoints found_;
};

/// The joints from `joint` up to the root, itself included.
std::vector<std::uint16_t> chain_to_root(const SkeletonData& skeleton, std::uint16_t joint) {
    std::vector<std::uint16_t> chain;
    for (std::int32_t i = joint; i >= 0; i = skeleton.parents[static_cast<std::size_t>(i)]) {
        chain.push_back(static_cast<std::uint16_t>(i));
    }
    return chain;
}

/// The back from the hips to the neck or the head, where names leave it open: its first joint above
/// the hips and its last below the neck.
void find_back(const SkeletonData& skeleton, PartFinder& parts) {
    const BodyJoints& body = parts.found();
    const BodyPart top = body.has(BodyPart::Neck) ? BodyPart::Neck : BodyPart::Head;
    if (!body.has(top)) {
        return;
    }
    std::vector<std::uint16_t> chain = chain_to_root(skeleton, body[top]);
    const auto hips = std::find(chain.begin(), chain.end(), body[BodyPart::Hips]);
    chain.erase(hips == chain.end() ? chain.end() - 1 : hips, chain.end());
    if (chain.size() > 1) {
        parts.set(BodyPart::Chest, chain[1]);
        parts.set(BodyPart::Spine, chain.back());
    }
}

}  // namespace

BodyJoints find_body_joints(const SkeletonData& skeleton) {
    PartFinder parts(skeleton);
    for (const Side side : {Side::Left, Side::Right}) {
        const BodyPart first =
            side == Side::Left ? BodyPart::LeftShoulder : BodyPart::RightShoulder;
        for (const std::size_t limb : {1, 0, 2, 3, 4, 5, 6, 7}) {  // upper arm before collar bone
            const auto part = static_cast<BodyPart>(static_cast<std::size_t>(first) + limb);
            parts.find(part, side, names_of(limb));
        }
    }
    for (const BodyPart part :
         {BodyPart::Hips, BodyPart::Spine, BodyPart::Neck, BodyPart::Head, BodyPart::Chest}) {
        parts.find(part, Side::None, middle_names_of(part));
    }
    find_back(skeleton, parts);
    return parts.found();
}

}  // namespace limn

#include "content/load/motion/htr_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "content/load/motion/motion_text.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

// Techniques: char.htr-format

namespace limn {
namespace {

constexpr std::size_t kHtrValues = 7;  ///< translation, rotation, scale or length

/// A row of numbers.
using HtrRow = std::array<float, kHtrValues>;

struct HtrSegment {
    std::string name;
    std::string parent;
    std::size_t line = 0;
    bool has_base = false;
    HtrRow base = {};
    std::vector<HtrRow> frames;
};

class HtrParser {
  public:
    HtrParser(std::string_view text, const std::string& file, const HtrLimits& limits)
        : text_(text, file), file_(file), limits_(limits) {}

    Result<SkeletonMotion> parse() {
        std::string section;
        for (std::string_view line = next_line(); !line.empty(); line = next_line()) {
            if (line.front() == '[') {
                section = line.substr(1, line.find(']') - 1);
                if (equals_ignoring_case(section, "EndOfFile")) {
                    break;
                }
                if (!is_known(section)) {
                    return fail(
                        "{}: found the section {}, expected Header, SegmentNames&Hierarchy, "
                        "BasePosition or the name of a segment",
                        text_.position(), in_quotes(section));
                }
            } else if (equals_ignoring_case(section, "Header")) {
                LIMN_TRY(read_setting(line));
            } else if (equals_ignoring_case(section, "SegmentNames&Hierarchy")) {
                LIMN_TRY(read_segment(line));
            } else if (equals_ignoring_case(section, "BasePosition")) {
                LIMN_TRY(read_base(line));
            } else {
                LIMN_TRY(read_frame(section, line));
            }
        }
        return make_motion();
    }

  private:
    /// Without comments.
    std::string_view next_line() {
        while (true) {
            std::string_view line = text_.line();
            if (line.empty()) {
                return line;
            }
            line = line.substr(0, line.find('#'));
            line = line.substr(0, line.find_last_not_of(" \t") + 1);
            if (!line.empty()) {
                return line;
            }
        }
    }

    [[nodiscard]] bool is_known(std::string_view section) const {
        return equals_ignoring_case(section, "Header")
               || equals_ignoring_case(section, "SegmentNames&Hierarchy")
               || equals_ignoring_case(section, "BasePosition")
               || numbers_.contains(std::string(section));
    }

    Status bad_setting(std::string_view key, std::string_view found, const char* expected) {
        return fail(
            "{}: {}: found {}, expected {}", text_.position(), key, in_quotes(found), expected);
    }

    Status read_setting(std::string_view line) {
        const std::string_view key = take_word(line);
        const std::string_view value = take_word(line);
        if (equals_ignoring_case(key, "DataFrameRate")) {
            if (!parse_motion_number(value, rate_) || !(rate_ > 0 && rate_ <= 1e5f)) {
                return bad_setting(key, value, "frames per second, more than 0 and at most 100000");
            }
        } else if (equals_ignoring_case(key, "EulerRotationOrder")) {
            order_.clear();
            for (const char axis : value) {
                order_ += static_cast<char>(axis >= 'a' ? axis - 'a' + 'A' : axis);
            }
            std::string sorted = order_;
            std::sort(sorted.begin(), sorted.end());
            if (sorted != "XYZ") {
                return bad_setting(key, value, "X, Y and Z in some order");
            }
        } else if (equals_ignoring_case(key, "CalibrationUnits")) {
            const std::pair<std::string_view, float> units[] = {
                {"mm", 1e-3f}, {"cm", 1e-2f}, {"m", 1.0f}, {"in", 0.0254f}, {"inches", 0.0254f}};
            const auto* const unit =
                std::find_if(std::begin(units), std::end(units), [&](const auto& known) {
                    return equals_ignoring_case(known.first, value);
                });
            if (unit == std::end(units)) {
                return bad_setting(key, value, "mm, cm, m or in");
            }
            meters_ = unit->second;
        } else if (equals_ignoring_case(key, "RotationUnits")) {
            in_degrees_ = equals_ignoring_case(value, "Degrees");
            if (!in_degrees_ && !equals_ignoring_case(value, "Radians")) {
                return bad_setting(key, value, "Degrees or Radians");
            }
        } else if (equals_ignoring_case(key, "GlobalAxisofGravity")) {
            z_is_up_ = equals_ignoring_case(value, "Z");
            if (!z_is_up_ && !equals_ignoring_case(value, "Y")) {
                return bad_setting(key, value, "Y or Z");
            }
        }
        return Done{};
    }

    Status read_segment(std::string_view line) {
        HtrSegment segment;
        segment.name = take_word(line);
        segment.parent = take_word(line);
        segment.line = text_.line_number();
        if (segment.parent.empty()) {
            return fail(
                "{}: found no parent of {}, expected one or GLOBAL", text_.position(),
                in_quotes(segment.name));
        }
        if (segments_.size() >= limits_.max_joints) {
            return fail("{}: found more than {} segments", text_.position(), limits_.max_joints);
        }
        if (!numbers_.try_emplace(segment.name, segments_.size()).second) {
            return fail(
                "{}: found the segment {} again", text_.position(), in_quotes(segment.name));
        }
        segments_.push_back(std::move(segment));
        return Done{};
    }

    Result<HtrRow> read_row(std::string_view line) {
        HtrRow row = {};
        for (std::size_t i = 0; i < kHtrValues; ++i) {
            const std::string_view word = take_word(line);
            if (!parse_motion_number(word, row[i])) {
                return fail(
                    "{}: found {} as number {}, expected {} numbers", text_.position(),
                    word.empty() ? "nothing" : in_quotes(word), i + 1, kHtrValues);
            }
        }
        if (!take_word(line).empty()) {
            return fail("{}: found more than {} numbers in a row", text_.position(), kHtrValues);
        }
        return row;
    }

    Status read_base(std::string_view line) {
        const std::string name(take_word(line));
        const auto found = numbers_.find(name);
        if (found == numbers_.end()) {
            return fail(
                "{}: found the base position of {}, expected a segment of the hierarchy",
                text_.position(), in_quotes(name));
        }
        HtrSegment& segment = segments_[found->second];
        if (std::exchange(segment.has_base, true)) {
            return fail("{}: found a second base position of {}", text_.position(), name);
        }
        segment.base = LIMN_TRY(read_row(line));
        return Done{};
    }

    Status read_frame(const std::string& section, std::string_view line) {
        if (section.empty()) {
            return fail("{}: found {}, expected [Header]", text_.position(), in_quotes(line));
        }
        HtrSegment& segment = segments_[numbers_.at(section)];
        const std::string_view number = take_word(line);
        float frame = 0;
        if (!parse_motion_number(number, frame)
            || frame != static_cast<float>(segment.frames.size() + 1)) {
            return fail(
                "{}: found frame {} of {}, expected {}", text_.position(), in_quotes(number),
                in_quotes(section), segment.frames.size() + 1);
        }
        if (segment.frames.size() >= limits_.max_frames || ++keys_ > limits_.max_keys) {
            return fail("{}: found too many frames", text_.position());
        }
        segment.frames.push_back(LIMN_TRY(read_row(line)));
        if (!(segment.frames.back()[6] > 0)) {
            return fail(
                "{}: found the scale {} of {}, expected more than 0", text_.position(),
                segment.frames.back()[6], in_quotes(section));
        }
        return Done{};
    }

    // ---- skeleton -----------------------------------------------------------------------------

    /// Segments parents first, or an error for a cycle or an unknown parent.
    Result<std::vector<std::size_t>> find_order() const {
        std::vector<std::vector<std::size_t>> children(segments_.size());
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            const HtrSegment& segment = segments_[i];
            if (equals_ignoring_case(segment.parent, "GLOBAL")) {
                order.push_back(i);
                continue;
            }
            const auto parent = numbers_.find(segment.parent);
            if (parent == numbers_.end()) {
                return fail(
                    "{}:{}: found the parent {}, expected a segment or GLOBAL", file_, segment.line,
                    in_quotes(segment.parent));
            }
            children[parent->second].push_back(i);
        }
        for (std::size_t next = 0; next < order.size(); ++next) {  // grows
            const std::vector<std::size_t>& below = children[order[next]];
            order.insert(order.end(), below.begin(), below.end());
        }
        if (order.size() != segments_.size()) {
            return fail("{}: found parents in a cycle, expected a tree below GLOBAL", file_);
        }
        return order;
    }

    [[nodiscard]] Vec3 position_of(const HtrRow& row) const {
        const Vec3 p = meters_ * Vec3(row[0], row[1], row[2]);
        return z_is_up_ ? Vec3(p.x, p.z, -p.y) : p;
    }

    [[nodiscard]] Quat rotation_of(const HtrRow& row) const {
        glm::dquat rotation(1, 0, 0, 0);
        for (const char letter : order_) {
            const int axis = letter - 'X';
            const double value = static_cast<double>(row[3 + static_cast<std::size_t>(axis)]);
            const double half = 0.5 * (in_degrees_ ? glm::radians(value) : value);
            glm::dvec3 along(0);
            along[axis] = std::sin(half);
            rotation = rotation * glm::dquat(std::cos(half), along.x, along.y, along.z);
        }
        rotation = glm::normalize(rotation);
        const Quat q(rotation);
        return z_is_up_ ? Quat(q.w, q.x, q.z, -q.y) : q;
    }

    Result<SkeletonMotion> make_motion() {
        if (segments_.empty()) {
            return fail("{}: found no segments, expected [SegmentNames&Hierarchy]", file_);
        }
        const std::vector<std::size_t> order = LIMN_TRY(find_order());
        std::vector<std::int32_t> joint_of(segments_.size(), -1);
        const std::size_t frames = segments_[order[0]].frames.size();
        SkeletonMotion motion;
        motion.skeleton.name = std::filesystem::path(file_).stem().string();
        ClipSheet sheet;
        for (std::size_t j = 0; j < order.size(); ++j) {
            const HtrSegment& segment = segments_[order[j]];
            if (!segment.has_base) {
                return fail(
                    "{}:{}: found no base position of {}", file_, segment.line,
                    in_quotes(segment.name));
            }
            if (segment.frames.size() != frames) {
                return fail(
                    "{}: found {} frames of {}, expected {} as of {}", file_, segment.frames.size(),
                    in_quotes(segment.name), frames, in_quotes(segments_[order[0]].name));
            }
            joint_of[order[j]] = static_cast<std::int32_t>(j);
            const bool is_root = equals_ignoring_case(segment.parent, "GLOBAL");
            SkeletonData& skeleton = motion.skeleton;
            skeleton.joints.push_back(segment.name);
            skeleton.parents.push_back(
                j == 0    ? -1
                : is_root ? 0
                          : joint_of[numbers_.at(segment.parent)]);
            skeleton.rest.translations.push_back(position_of(segment.base));
            skeleton.rest.rotations.push_back(rotation_of(segment.base));
            skeleton.rest.scales.emplace_back(1);
            for (auto* list : {&sheet.rotating, &sheet.translating, &sheet.scaling}) {
                list->push_back(static_cast<std::uint16_t>(j));
            }
        }
        for (std::size_t f = 0; f < frames; ++f) {
            sheet.times.push_back(static_cast<float>(static_cast<double>(f) / rate_));
            for (std::size_t j = 0; j < order.size(); ++j) {
                const HtrRow& row = segments_[order[j]].frames[f];
                const std::size_t count = sheet.rotations.size();
                const Quat q = motion.skeleton.rest.rotations[j] * rotation_of(row);
                sheet.rotations.push_back(
                    f > 0 ? to_same_hemisphere(sheet.rotations[count - order.size()], q) : q);
                sheet.translations.push_back(
                    motion.skeleton.rest.translations[j] + position_of(row));
                sheet.scales.emplace_back(row[6]);
            }
        }
        motion.clip.name = motion.skeleton.name;
        if (frames > 0) {
            motion.clip.duration = sheet.times.back();
            motion.clip.sheets.push_back(std::move(sheet));
        }
        for (const Status& status :
             {check_skeleton(motion.skeleton),
              check_clip(motion.clip, motion.skeleton.joints.size(), 0)}) {
            if (!status) {
                return fail("{}: {}", file_, status.error().message);
            }
        }
        return motion;
    }

    MotionText text_;
    const std::string& file_;
    const HtrLimits& limits_;
    float rate_ = 30;
    std::string order_ = "ZYX";
    float meters_ = 1e-3f;
    bool in_degrees_ = true;
    bool z_is_up_ = false;
    std::vector<HtrSegment> segments_;
    std::map<std::string, std::size_t> numbers_;  ///< of the segments
    std::size_t keys_ = 0;
};

}  // namespace

Result<SkeletonMotion>
parse_htr(std::string_view text, const std::string& file, const HtrLimits& limits) {
    return HtrParser(text, file, limits).parse();
}

Result<SkeletonMotion> load_htr(const std::string& path) {
    const HtrLimits limits;
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, limits.max_bytes));
    return parse_htr({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

}  // namespace limn

#include "content/load/motion/bvh_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "content/load/motion/motion_text.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <utility>

// Techniques: char.bvh-format

namespace limn {
namespace {

constexpr std::array<std::string_view, kBvhChannels> kChannelNames = {
    "Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"};
constexpr float kLongestFrame = 1e6f;  ///< [s]

class BvhParser {
  public:
    BvhParser(std::string_view text, const std::string& file, const BvhLimits& limits)
        : words_(text, file), limits_(limits) {}

    Result<BvhFile> parse() {
        if (equals_ignoring_case(words_.peek(), "HIERARCHY")) {
            words_.word();
        }
        LIMN_TRY(expect("ROOT"));
        std::string root = LIMN_TRY(read_name());
        LIMN_TRY(open_joint(std::move(root), false));
        while (!open_.empty()) {  // no recursion: chains may be long
            LIMN_TRY(read_item());
        }
        if (equals_ignoring_case(words_.peek(), "ROOT")) {
            words_.word();
            return fail("{}: found a second ROOT, expected MOTION", words_.position());
        }
        LIMN_TRY(expect("MOTION"));
        LIMN_TRY(read_frame_count());
        LIMN_TRY(read_frame_time());
        LIMN_TRY(read_rows());
        return std::move(bvh_);
    }

  private:
    /// A block that is being read.
    struct OpenJoint {
        std::size_t joint = 0;
        std::size_t line = 0;  ///< of its brace
        bool has_offset = false;
        bool has_channels = false;
    };

    Status expect(std::string_view keyword, std::string_view marks = "{}") {
        const std::string_view found = words_.word(marks);
        if (!equals_ignoring_case(found, keyword)) {
            return fail(
                "{}: found {}, expected {}", words_.position(), found_motion_word(found), keyword);
        }
        return Done{};
    }

    /// The words before the brace.
    Result<std::string> read_name() {
        std::string name(words_.rest_of_line("{"));
        if (name.empty()) {
            const std::string_view word = words_.word();
            if (word.empty() || word == "{" || word == "}") {
                return fail(
                    "{}: found {}, expected the name of a joint", words_.position(),
                    found_motion_word(word));
            }
            name = word;
        }
        return name;
    }

    Status open_joint(std::string name, bool is_end) {
        LIMN_TRY(expect("{"));
        if (bvh_.joints.size() >= limits_.max_joints) {
            return fail("{}: found more than {} joints", words_.position(), limits_.max_joints);
        }
        BvhJoint& joint = bvh_.joints.emplace_back();
        joint.name = std::move(name);
        joint.parent = open_.empty() ? -1 : static_cast<std::int32_t>(open_.back().joint);
        joint.is_end = is_end;
        joint.first_value = values_per_row_;
        open_.push_back({bvh_.joints.size() - 1, words_.line_number()});
        return Done{};
    }

    /// One entry of the innermost open block, or its end.
    Status read_item() {
        const bool is_end = bvh_.joints[open_.back().joint].is_end;
        const std::string_view found = words_.word();
        if (equals_ignoring_case(found, "OFFSET")) {
            return read_offset();
        }
        if (equals_ignoring_case(found, "CHANNELS") && !is_end) {
            return read_channels();
        }
        if (equals_ignoring_case(found, "JOINT") && !is_end) {
            return open_joint(LIMN_TRY(read_name()), false);
        }
        if (equals_ignoring_case(found, "End") && !is_end) {
            LIMN_TRY(expect("Site"));
            words_.rest_of_line("{");  // some programs write a name
            return open_joint("", true);
        }
        if (found == "}") {
            return close_joint();
        }
        const std::string block =
            format_text("the block of {} that begins in line {}", block_name(), open_.back().line);
        if (found.empty()) {
            return fail(
                "{}: unexpected end of the file, unclosed block: expected } for {}",
                words_.position(), block);
        }
        return fail(
            "{}: found {}, expected {} or } in {}", words_.position(), in_quotes(found),
            is_end ? "OFFSET" : "OFFSET, CHANNELS, JOINT, End Site", block);
    }

    [[nodiscard]] std::string block_name() const {
        const BvhJoint& joint = bvh_.joints[open_.back().joint];
        return joint.is_end ? "an end site" : in_quotes(joint.name);
    }

    Status read_offset() {
        if (std::exchange(open_.back().has_offset, true)) {
            return fail("{}: found a second OFFSET of {}", words_.position(), block_name());
        }
        Vec3& offset = bvh_.joints[open_.back().joint].offset;
        for (int axis = 0; axis < 3; ++axis) {
            offset[axis] = LIMN_TRY(words_.number("OFFSET"));
        }
        return Done{};
    }

    Status read_channels() {
        if (std::exchange(open_.back().has_channels, true)) {
            return fail("{}: found second CHANNELS of {}", words_.position(), block_name());
        }
        if (open_.back().joint + 1 != bvh_.joints.size()) {  // whose order would be ambiguous
            return fail(
                "{}: found CHANNELS of {} after its children, expected them before",
                words_.position(), block_name());
        }
        BvhJoint& joint = bvh_.joints[open_.back().joint];
        const std::string_view count_word = words_.word();
        int count = -1;
        const char* const end = count_word.data() + count_word.size();
        const auto [stop, error] = std::from_chars(count_word.data(), end, count);
        if (error != std::errc{} || stop != end || count < 0 || count > kBvhChannels) {
            return fail(
                "{}: CHANNELS: found {}, expected their number, 0 to {}", words_.position(),
                found_motion_word(count_word), kBvhChannels);
        }
        for (int i = 0; i < count; ++i) {
            const std::string_view word = words_.word();
            const auto found = std::find_if(
                kChannelNames.begin(), kChannelNames.end(),
                [&](std::string_view name) { return equals_ignoring_case(name, word); });
            const auto channel = static_cast<BvhChannel>(found - kChannelNames.begin());
            const bool is_repeated =
                std::find(joint.channels.begin(), joint.channels.end(), channel)
                != joint.channels.end();
            if (found == kChannelNames.end() || is_repeated) {
                return fail(
                    "{}: CHANNELS of {}: found {}{}, expected {} different ones of {}",
                    words_.position(), block_name(), found_motion_word(word),
                    is_repeated ? " again" : "", count, join_text(kChannelNames, " "));
            }
            joint.channels.push_back(channel);
        }
        joint.first_value = values_per_row_;
        values_per_row_ += joint.channels.size();
        return Done{};
    }

    Status close_joint() {
        if (!open_.back().has_offset) {
            return fail("{}: found no OFFSET of {}, expected one", words_.position(), block_name());
        }
        open_.pop_back();
        return Done{};
    }

    Status read_frame_count() {
        LIMN_TRY(expect("Frames", ":"));
        LIMN_TRY(expect(":", ":"));
        const std::string_view word = words_.word();
        const char* const end = word.data() + word.size();
        const auto [stop, error] = std::from_chars(word.data(), end, bvh_.frames);
        if (word.empty() || error != std::errc{} || stop != end
            || bvh_.frames > limits_.max_frames) {
            return fail(
                "{}: Frames: found {}, expected their number, 0 to {}", words_.position(),
                found_motion_word(word), limits_.max_frames);
        }
        frames_line_ = words_.line_number();
        return Done{};
    }

    Status read_frame_time() {
        LIMN_TRY(expect("Frame"));
        LIMN_TRY(expect("Time", ":"));
        LIMN_TRY(expect(":", ":"));
        bvh_.frame_time = LIMN_TRY(words_.number("Frame Time"));
        if (!(bvh_.frame_time > 0 && bvh_.frame_time <= kLongestFrame)) {
            return fail(
                "{}: found the frame time {}, expected more than 0 and at most {} s",
                words_.position(), bvh_.frame_time, kLongestFrame);
        }
        return Done{};
    }

    Status read_rows() {
        const std::size_t width = values_per_row_;
        std::size_t rows = 0;
        for (std::string_view line = words_.line(); !line.empty(); line = words_.line()) {
            if (rows == bvh_.frames && width > 0) {
                bvh_.warnings.push_back(format_text(
                    "{}: found rows after {} frames, expected the end of the file; they are "
                    "ignored",
                    words_.position(), rows));
                return Done{};
            }
            if (bvh_.values.size() + width > limits_.max_values) {
                return fail(
                    "{}: found more than {} numbers", words_.position(), limits_.max_values);
            }
            LIMN_TRY(read_row(line, rows));
            ++rows;
        }
        if (rows < bvh_.frames && width > 0) {
            return fail(
                "{}: found {} rows, expected {} as in line {}", words_.position(), rows,
                bvh_.frames, frames_line_);
        }
        return Done{};
    }

    Status read_row(std::string_view line, std::size_t row) {
        std::size_t count = 0;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            float value = 0;
            if (!parse_motion_number(word, value)) {
                return fail(
                    "{}: found {} as number {} of frame {}, expected a number", words_.position(),
                    in_quotes(word), count, row);
            }
            if (++count <= values_per_row_) {
                bvh_.values.push_back(value);
            }
        }
        if (count != values_per_row_) {
            return fail(
                "{}: found {} numbers in the row of frame {}, expected {}, one per channel",
                words_.position(), count, row, values_per_row_);
        }
        return Done{};
    }

    MotionText words_;
    const BvhLimits& limits_;
    BvhFile bvh_;
    std::vector<OpenJoint> open_;
    std::size_t values_per_row_ = 0;
    std::size_t frames_line_ = 0;
};

void append_number(std::string& text, float value) {
    std::array<char, 32> digits;
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), written.ptr);
}

/// Tabs at this depth: not so many that a chain of thousands would grow with their square.
std::size_t indent_of(std::size_t depth) {
    return std::min<std::size_t>(depth, 40);
}

/// The lines of a joint up to its children.
void append_joint(std::string& text, const BvhJoint& joint, std::size_t depth) {
    const std::string indent(indent_of(depth), '\t');
    text += indent;
    text += joint.is_end ? "End Site" : joint.parent < 0 ? "ROOT " : "JOINT ";
    text += joint.name + "\n" + indent + "{\n" + indent + "\tOFFSET";
    for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        append_number(text, joint.offset[axis]);
    }
    text += '\n';
    if (!joint.is_end) {
        text += format_text("{}\tCHANNELS {}", indent, joint.channels.size());
        for (const BvhChannel channel : joint.channels) {
            text += ' ';
            text += kChannelNames[static_cast<std::size_t>(channel)];
        }
        text += '\n';
    }
}

}  // namespace

std::size_t BvhFile::channels() const {
    std::size_t count = 0;
    for (const BvhJoint& joint : joints) {
        count += joint.channels.size();
    }
    return count;
}

Result<BvhFile> parse_bvh(std::string_view text, const std::string& file, const BvhLimits& limits) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        return fail("{}: found a text in UTF-16, expected UTF-8 or ASCII", file);
    }
    return BvhParser(text, file, limits).parse();
}

Result<BvhFile> load_bvh(const std::string& path, const BvhLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, limits.max_bytes));
    return parse_bvh({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

std::string write_bvh(const BvhFile& bvh) {
    std::string text = "HIERARCHY\n";
    std::vector<std::size_t> open;  // the joint being written and its ancestors
    const auto close = [&] {
        open.pop_back();
        text += std::string(indent_of(open.size()), '\t') + "}\n";
    };
    for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
        const std::int32_t parent = bvh.joints[i].parent;
        while (!open.empty() && open.back() != static_cast<std::size_t>(parent)) {
            close();
        }
        append_joint(text, bvh.joints[i], open.size());
        open.push_back(i);
    }
    while (!open.empty()) {
        close();
    }
    text += format_text("MOTION\nFrames: {}\nFrame Time: ", bvh.frames);
    append_number(text, bvh.frame_time);
    text += '\n';
    const std::size_t width = bvh.channels();
    for (std::size_t i = 0; i < bvh.values.size(); ++i) {
        append_number(text, bvh.values[i]);
        text += (i + 1) % width == 0 ? '\n' : ' ';
    }
    return text;
}

}  // namespace limn

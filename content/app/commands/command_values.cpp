#include "content/app/commands/command_values.h"

#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>

namespace limn {
namespace {

/// Reads all of `text` as a number; false if anything is left, missing or out of the type's range.
template <typename Number>
bool read_all(std::string_view text, Number& number) {
    const char* end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, number);
    return code == std::errc{} && stop == end;
}

}  // namespace

Result<IVec2> parse_size(std::string_view text) {
    const std::size_t cross = text.find('x');
    IVec2 size = {0, 0};
    if (cross == std::string_view::npos || !read_all(text.substr(0, cross), size.x)
        || !read_all(text.substr(cross + 1), size.y) || size.x < 1 || size.y < 1
        || size.x > kMaxImageSide || size.y > kMaxImageSide || size.x * size.y > kMaxImagePixels) {
        return fail(
            "found \"{}\", expected WIDTHxHEIGHT such as 1280x720, each 1 to {}, {} pixels at most",
            text, kMaxImageSide, kMaxImagePixels);
    }
    return size;
}

Result<FrameRange> parse_frame_range(std::string_view text) {
    const std::size_t colon = text.find(':');
    FrameRange range;
    const bool first_ok = read_all(text.substr(0, colon), range.first);
    const bool last_ok =
        colon == std::string_view::npos || read_all(text.substr(colon + 1), range.last);
    if (colon == std::string_view::npos) {
        range.last = range.first;
    }
    if (!first_ok || !last_ok || range.first < 0 || range.last < range.first
        || range.last >= kMaxFrames) {
        return fail(
            "found \"{}\", expected FIRST:LAST such as 0:99, 0 <= FIRST <= LAST < {}", text,
            kMaxFrames);
    }
    return range;
}

Result<std::int64_t> parse_integer(std::string_view text, std::int64_t min, std::int64_t max) {
    std::int64_t number = 0;
    if (!read_all(text, number) || number < min || number > max) {
        return fail("found \"{}\", expected a whole number from {} to {}", text, min, max);
    }
    return number;
}

Result<double> parse_number(std::string_view text, double min, double max) {
    double number = 0.0;
    if (!read_all(text, number) || !(number >= min && number <= max)) {
        return fail("found \"{}\", expected a number from {} to {}", text, min, max);
    }
    return number;
}

Result<Assignment> parse_assignment(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
        return fail("found \"{}\", expected path=value such as exposure.ev=1", text);
    }
    return Assignment{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Result<std::vector<std::string>> parse_list(std::string_view text) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        if (comma == begin) {
            return fail("found \"{}\", expected names separated by commas", text);
        }
        parts.emplace_back(text.substr(begin, comma - begin));
        begin = comma + 1;
    }
    return parts;
}

Result<gpu::Profile> parse_profile(std::string_view text) {
    if (text == "gpu") {
        return gpu::Profile::Gpu;
    }
    if (text == "software") {
        return gpu::Profile::Software;
    }
    return fail("found \"{}\", expected gpu or software", text);
}

Result<SampleMean> parse_average(std::string_view text) {
    if (text == "light") {
        return SampleMean::Light;
    }
    if (text == "displayed") {
        return SampleMean::Displayed;
    }
    return fail("found \"{}\", expected light or displayed", text);
}

std::string one_line(std::string text) {
    text = printable_lines(std::move(text));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string printable_lines(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte < 0x20 && text[i] != '\n') || byte == 0x7f) {
            text[i] = ' ';
        } else if (
            byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) {
            text.replace(i, 2, " ");  // U+0080 .. U+009F in UTF-8
        }
    }
    return text;
}

}  // namespace limn

#include "content/load/motion/motion_text.h"

#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace limn {
namespace {

constexpr std::string_view kMotionSpaces = " \t\r\n\v\f";
constexpr std::string_view kMotionByteOrderMark = "\xef\xbb\xbf";
constexpr double kLargestMotionNumber = 1e9;

std::size_t length_of_word(std::string_view text, std::string_view marks) {
    if (!text.empty() && marks.find(text[0]) != std::string_view::npos) {
        return 1;
    }
    const auto end = std::find_if(text.begin(), text.end(), [&](char c) {
        return kMotionSpaces.find(c) != std::string_view::npos
               || marks.find(c) != std::string_view::npos;
    });
    return static_cast<std::size_t>(end - text.begin());
}

char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

MotionText::MotionText(std::string_view text, const std::string& file) : text_(text), file_(file) {
    if (text_.starts_with(kMotionByteOrderMark)) {
        text_.remove_prefix(kMotionByteOrderMark.size());
    }
}

void MotionText::advance(std::size_t count) {
    for (const char c : text_.substr(0, count)) {
        line_ += c == '\r' || (c == '\n' && !after_return_) ? 1 : 0;
        after_return_ = c == '\r';
    }
    text_.remove_prefix(count);
}

void MotionText::skip_spaces() {
    advance(std::min(text_.find_first_not_of(kMotionSpaces), text_.size()));
}

std::string_view MotionText::peek(std::string_view marks) const {
    const std::string_view next =
        text_.substr(std::min(text_.find_first_not_of(kMotionSpaces), text_.size()));
    return next.substr(0, length_of_word(next, marks));
}

std::string_view MotionText::word(std::string_view marks) {
    skip_spaces();
    const std::string_view found = text_.substr(0, length_of_word(text_, marks));
    found_line_ = found.empty() ? found_line_ : line_;
    advance(found.size());
    return found;
}

std::string_view MotionText::rest_of_line(std::string_view stops) {
    const auto end = std::find_if(text_.begin(), text_.end(), [&](char c) {
        return c == '\n' || c == '\r' || stops.find(c) != std::string_view::npos;
    });
    std::string_view rest = text_.substr(0, static_cast<std::size_t>(end - text_.begin()));
    advance(rest.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kMotionSpaces), rest.size()));
    return rest.substr(0, rest.find_last_not_of(kMotionSpaces) + 1);
}

std::string_view MotionText::line() {
    skip_spaces();
    found_line_ = text_.empty() ? found_line_ : line_;
    return rest_of_line();
}

Result<float> MotionText::number(std::string_view what) {
    const std::string_view found = word();
    float value = 0;
    if (!parse_motion_number(found, value)) {
        return fail(
            "{}: {}: found {}, expected a number", position(), what, found_motion_word(found));
    }
    return value;
}

std::string MotionText::position() const {
    return format_text("{}:{}", file_, found_line_);
}

std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kMotionSpaces), line.size()));
    const std::string_view word = line.substr(0, length_of_word(line, ""));
    line.remove_prefix(word.size());
    return word;
}

bool parse_motion_number(std::string_view word, float& number) {
    const char* const end = word.data() + word.size();
    const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
    auto [stop, error] = std::from_chars(begin, end, number);
    if (error == std::errc::result_out_of_range) {  // 1e-50 is 0
        double exact = 0;
        const auto retried = std::from_chars(begin, end, exact);
        error = retried.ec;
        number = static_cast<float>(std::clamp(exact, -1e30, 1e30));
    }
    return !word.empty() && error == std::errc{} && stop == end
           && std::abs(static_cast<double>(number)) <= kLargestMotionNumber;
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return lower_case(x) == lower_case(y);
    });
}

std::string found_motion_word(std::string_view word) {
    return word.empty() ? "the end of the file" : in_quotes(word);
}

}  // namespace limn

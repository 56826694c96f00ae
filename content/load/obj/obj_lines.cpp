#include "content/load/obj/obj_lines.h"

#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace limn {

namespace {

/// [file's unit]; beyond it cross products of edges overflow a float.
constexpr double kLargestObjNumber = 1e9;

constexpr std::string_view kObjSpaces = " \t\r\v\f";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string_view without_leading_spaces(std::string_view text) {
    return text.substr(std::min(text.find_first_not_of(kObjSpaces), text.size()));
}

/// The word that `text` begins with; "" for a comment.
std::string_view first_word(std::string_view text) {
    const std::string_view word = text.substr(0, text.find_first_of(kObjSpaces));
    std::size_t comment = word.find('#');
    while (comment != std::string_view::npos && comment > 0 && word[comment - 1] == '.') {
        comment = word.find('#', comment + 1);
    }
    return word.substr(0, comment);
}

std::optional<double> parse_obj_number(std::string_view word) {
    double value = 0;
    const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const end = word.data() + word.size();
    const auto [stop, code] = std::from_chars(begin, end, value);
    if (word.empty() || stop != end || code != std::errc{}
        || !(std::abs(value) <= kLargestObjNumber)) {
        return std::nullopt;
    }
    return value;
}

}  // namespace

ObjLines::ObjLines(std::string_view text, const std::string& file)
    : text_(text), file_(file),
      end_of_line_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {
    if (text_.starts_with(kByteOrderMark)) {
        text_.remove_prefix(kByteOrderMark.size());
    }
}

bool ObjLines::next() {
    if (at_ >= text_.size()) {
        return false;
    }
    joined_.clear();
    number_ = next_number_;
    rest_ = take_line();
    const bool is_comment = without_leading_spaces(rest_).starts_with('#');
    while (!is_comment && rest_.ends_with('\\') && at_ < text_.size()) {
        if (joined_.empty()) {
            joined_ = rest_;
        }
        joined_.back() = ' ';
        joined_ += take_line();
        rest_ = joined_;
    }
    return true;
}

std::string_view ObjLines::word() {
    rest_ = without_leading_spaces(rest_);
    const std::string_view found = first_word(rest_);
    const bool is_comment_next = found.size() < rest_.size() && rest_[found.size()] == '#';
    rest_.remove_prefix(is_comment_next ? rest_.size() : found.size());
    return found;
}

Result<double> ObjLines::number(std::string_view what) {
    const std::string_view found = word();
    if (const std::optional<double> value = parse_obj_number(found)) {
        return *value;
    }
    return fail(
        "{}: {}: found {}, expected a number of at most {}", position(), what, found_word(found),
        kLargestObjNumber);
}

std::string_view ObjLines::peek() const {
    return first_word(without_leading_spaces(rest_));
}

bool ObjLines::is_number_next() const {
    return parse_obj_number(peek()).has_value();
}

std::string_view ObjLines::rest() {
    rest_ = without_leading_spaces(rest_);
    const std::size_t last = rest_.find_last_not_of(kObjSpaces);
    return std::exchange(rest_, {}).substr(0, last == std::string_view::npos ? 0 : last + 1);
}

bool ObjLines::has_word() const {
    return !peek().empty();
}

std::string ObjLines::position() const {
    return format_text("{}:{}", file_, number_);
}

std::string_view ObjLines::take_line() {
    const std::size_t end = std::min(text_.find(end_of_line_, at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    at_ = end + 1;
    ++next_number_;
    return line;
}

std::string found_word(std::string_view word) {
    return word.empty() ? "nothing" : in_quotes(word);
}

Status check_encoding(std::string_view text, const std::string& file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        return fail("{}: found a text in UTF-16, expected UTF-8 or ASCII", file);
    }
    return Done{};
}

void ObjWarnings::add(std::string line) {
    if (lines_.size() < kMaxLines) {
        lines_.push_back(std::move(line));
    } else {
        ++dropped_;
    }
}

void ObjWarnings::finish(const std::string& file) {
    if (dropped_ > 0) {
        lines_.push_back(format_text("{}: {} more warnings", file, dropped_));
    }
}

}  // namespace limn

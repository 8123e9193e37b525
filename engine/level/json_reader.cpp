#include "engine/level/json_reader.hpp"
#include "engine/settings/rules/messages.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>

namespace wadi {
namespace {

std::string position_text(const std::string& text, std::size_t byte) {
    const std::size_t end = std::min(byte == 0 ? 0 : byte - 1, text.size());
    std::size_t line = 1;
    std::size_t column = 1;
    for (std::size_t n = 0; n < end; ++n) {
        if (text[n] == '\n') {
            ++line;
            column = 1;
        } else {
            ++column;
        }
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// nlohmann's message without its own prefix "[json.exception...] parse error at line 1, column 2: ".
std::string reason_of(const std::string& what) {
    const std::size_t syntax = what.find("syntax error");
    if (syntax != std::string::npos) return what.substr(syntax);
    const std::size_t bracket = what.find("] ");
    return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

/// Lists and objects within each other: levels have 7. Reading, copying and printing a value take stack by its depth.
constexpr std::size_t DEPTH_MOST = 32;

/// Looks through a text once, before values are made of it. (A parser with a callback looks through a whole list at each end of
/// one of its elements.)
class TextSurvey : public nlohmann::json_sax<Json> {
  public:
    explicit TextSurvey(const std::string& text) : text_(text) {}
    const Status& status() const { return status_; }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(std::int64_t) override { return true; }
    bool number_unsigned(std::uint64_t) override { return true; }
    bool number_float(double, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return go_down(); }
    bool start_array(std::size_t) override { return go_down(); }
    bool end_object() override { return go_up(); }
    bool end_array() override { return go_up(); }
    bool key(std::string& name) override {
        if (keys_.size() == 1) key_of_root_ = name;
        if (keys_.back().insert(name).second) return true;
        return fail("the key \"" + name + "\" is given twice in one object");
    }
    bool parse_error(std::size_t byte, const std::string&, const Json::exception& failure) override {
        return fail(position_text(text_, byte) + ": " + reason_of(failure.what()));
    }

  private:
    bool fail(const std::string& message) {
        status_ = error(Code::bad_file, message);
        return false;
    }
    bool go_down() {
        keys_.emplace_back();
        if (keys_.size() <= DEPTH_MOST) return true;
        return fail((key_of_root_.empty() ? "the level" : key_of_root_) + " is nested more than " + std::to_string(DEPTH_MOST) +
                    " deep");
    }
    bool go_up() {
        keys_.pop_back();
        return true;
    }

    const std::string& text_;
    Status status_;
    std::vector<std::set<std::string>> keys_; // of the objects around, none of a list
    std::string key_of_root_;
};

/// Texts in single quotes become such in double ones, byte for byte: places in messages stay.
Result<std::string> double_quoted(std::string text) {
    char within = 0; // a quote, '/' or '*' of a comment
    for (std::size_t n = 0; n < text.size(); ++n) {
        const char c = text[n], next = n + 1 < text.size() ? text[n + 1] : '\0';
        if (within == '/') {
            if (c == '\n') within = 0;
        } else if (within == '*') {
            if (c == '*' && next == '/') within = 0, ++n;
        } else if (within != 0) {
            if (c == '"' && within == '\'')
                return error(Code::bad_file, position_text(text, n + 1) +
                                                 ": a text in single quotes holds a double quote; write \\\" or put "
                                                 "the text into double quotes");
            if (c == '\\') ++n;
            if (c != within) continue;
            text[n] = '"';
            within = 0;
        } else if (c == '/' && (next == '/' || next == '*')) {
            within = next;
            ++n;
        } else if (c == '"' || c == '\'') {
            within = c;
            text[n] = '"';
        }
    }
    return text;
}

void refuse(Status& status, std::string message) {
    if (status) status = error(Code::bad_file, std::move(message));
}

} // namespace

Result<Json> parse_json(const std::string& given) {
    constexpr bool strict = true, comments = true, throws = true;
    std::string replaced;
    if (given.find('\'') != std::string::npos) {
        auto quoted = double_quoted(given);
        if (!quoted) return quoted.status();
        replaced = std::move(*quoted);
    }
    const std::string& text = replaced.empty() ? given : replaced;
    TextSurvey survey(text);
    if (!Json::sax_parse(text, &survey, Json::input_format_t::json, strict, comments)) return survey.status();
    return Json::parse(text, nullptr, throws, comments);
}

std::string json_text(const Json& value) {
    constexpr std::size_t longest = 40;
    std::string text = value.dump();
    if (text.size() > longest) text = text.substr(0, longest) + " ...";
    return text;
}

double read_number(const Json& value, const std::string& path, double least, double most, Status& status) {
    if (!value.is_number()) {
        refuse(status, path + ": expected a number, found " + json_text(value));
        return 0;
    }
    const double number = value.get<double>();
    if (!(number >= least && number <= most)) refuse(status, outside_text(path, number, least, most));
    return number;
}

std::array<double, 2> read_pair(const Json& value, const std::string& path, double least, double most, Status& status) {
    if (!value.is_array() || value.size() != 2) {
        refuse(status, path + ": expected two numbers [x, y], found " + json_text(value));
        return {0, 0};
    }
    return {read_number(value[0], path + "[0]", least, most, status), read_number(value[1], path + "[1]", least, most, status)};
}

std::vector<const Json*> read_array(const Json& value, const std::string& path, std::size_t most, Status& status) {
    std::vector<const Json*> elements;
    if (!value.is_array())
        refuse(status, path + ": expected a list [...], found " + json_text(value));
    else if (value.size() > most)
        refuse(status, path + ": " + std::to_string(value.size()) + " elements are more than " + std::to_string(most));
    else
        for (const Json& element : value) elements.push_back(&element);
    return elements;
}

ObjectReader::ObjectReader(const Json& value, std::string path, Status& status) : path_(std::move(path)), status_(&status) {
    if (value.is_object())
        object_ = &value;
    else
        refuse(status,
               (path_.empty() ? std::string("the level") : path_) + ": expected an object {...}, found " + json_text(value));
}

const Json* ObjectReader::find(const char* key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    if (object_ == nullptr) return nullptr;
    const auto at = object_->find(key);
    return at == object_->end() ? nullptr : &*at;
}

const Json* ObjectReader::require(const char* key) {
    const Json* value = find(key);
    if (value == nullptr && missing_.empty()) missing_ = key;
    return value;
}

std::string ObjectReader::path_of(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

void ObjectReader::fail(const std::string& key, const std::string& message) {
    refuse(*status_, (key.empty() ? path_ : path_of(key)) + ": " + message);
}

void ObjectReader::number(const char* key, double& out, double least, double most) {
    if (const Json* value = find(key)) out = read_number(*value, path_of(key), least, most, *status_);
}

void ObjectReader::required_number(const char* key, double& out, double least, double most) {
    if (require(key) != nullptr) number(key, out, least, most);
}

void ObjectReader::whole_number(const char* key, int& out, int least, int most) {
    const Json* value = find(key);
    if (value == nullptr) return;
    const double number = read_number(*value, path_of(key), least, most, *status_);
    if (failed()) return;
    if (number != std::floor(number)) return fail(key, number_text(number) + " is not a whole number");
    out = static_cast<int>(number);
}

void ObjectReader::boolean(const char* key, bool& out) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_boolean()) return fail(key, "expected true or false, found " + json_text(*value));
    out = value->get<bool>();
}

void ObjectReader::string(const char* key, std::string& out) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_string()) return fail(key, "expected a text, found " + json_text(*value));
    out = value->get<std::string>();
}

void ObjectReader::pair(const char* key, std::array<double, 2>& out, double least, double most) {
    if (const Json* value = find(key)) out = read_pair(*value, path_of(key), least, most, *status_);
}

void ObjectReader::choice(const char* key, const std::vector<std::string>& names, int& index) {
    std::string name;
    string(key, name);
    if (failed() || object_ == nullptr || !object_->contains(key)) return;
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return fail(key, "\"" + name + "\" is not known" + suggestion(name, names));
    index = static_cast<int>(at - names.begin());
}

void ObjectReader::finish() {
    if (failed() || object_ == nullptr) return;
    for (const auto& [key, value] : object_->items())
        if (std::find(known_.begin(), known_.end(), key) == known_.end())
            return fail(key, "unknown key" + suggestion(key, known_));
    if (!missing_.empty()) fail(missing_, "missing");
}

} // namespace wadi

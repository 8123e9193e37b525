#include "source.hpp"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

namespace stagec {

void fail(const std::string& message) {
    std::cerr << message << "\n";
    std::exit(1);
}

std::string read_text(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) fail("stagec: cannot read " + path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream out(path, std::ios::binary);
    out << bytes;
    if (!out) fail("stagec: cannot write " + path);
}

void write_code(const std::string& path, const std::string& text) {
    std::ostringstream out;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line + "\n" == here) {
            out << "#line " << number + 1 << " \"" << path << "\"\n";
        } else {
            out << line << "\n";
        }
    }
    write_bytes(path, out.str());
}

std::string stem(const std::string& path) {
    const auto slash = path.find_last_of('/');
    const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
    return file.substr(0, file.find('.'));
}

int Source::line(std::size_t at) const {
    at = std::min(at, text.size());
    const std::size_t mark = at == 0 ? std::string::npos : text.rfind("\n#line ", at - 1);
    const std::size_t begin = mark == std::string::npos ? 0 : std::min(text.find('\n', mark + 1) + 1, at);
    const int first = mark == std::string::npos ? 1 : std::atoi(text.c_str() + mark + 7);
    return first + static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                               text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::string Source::place(std::size_t at) const { return path + ":" + std::to_string(line(at)); }

std::string Source::goes_on_at(std::size_t at) const { return "\n#line " + std::to_string(line(at)) + " \"" + path + "\"\n"; }

Source read_source(const std::string& path) {
    Source source{path, {}};
    const std::string text = read_text(path);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string two = text.substr(i, 2);
        if (two == "/*") source.fail(source.text.size(), "a block comment; stages have // comments only");
        if (two == "//") i = std::min(text.find('\n', i), text.size());
        if (i < text.size()) source.text += text[i];
    }
    return source;
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string word_at(const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    return text.substr(at, end - at);
}

std::size_t skip_blanks(const std::string& text, std::size_t at) {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
    return at;
}

std::size_t behind_bracket(const Source& source, std::size_t at) {
    const std::string open = "([{", close = ")]}";
    std::string expected; // what closes the brackets that are open
    for (std::size_t n = at; n < source.text.size(); ++n) {
        const char c = source.text[n];
        if (const auto kind = open.find(c); kind != std::string::npos) expected += close[kind];
        if (close.find(c) == std::string::npos) continue;
        if (expected.empty() || expected.back() != c) break;
        expected.pop_back();
        if (expected.empty()) return n + 1;
    }
    source.fail(at, std::string("nothing closes this ") + source.text[std::min(at, source.text.size() - 1)]);
}

std::vector<std::string> arguments(const Source& source, std::size_t at) {
    at = skip_blanks(source.text, at);
    if (at >= source.text.size() || source.text[at] != '(') return {};
    const std::size_t end = behind_bracket(source, at) - 1;
    std::vector<std::string> result(1);
    int depth = 0;
    for (++at; at < end; ++at) {
        const char c = source.text[at];
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (c == ',' && depth == 0) {
            result.emplace_back();
        } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
            result.back() += c;
        }
    }
    return result;
}

std::set<std::string> effects_in(const std::string& expression) {
    std::set<std::string> found;
    for_each_word(expression, [&](const std::string& word, std::size_t) {
        if (word.starts_with("EFFECT_")) found.insert(word);
    });
    return found;
}

} // namespace stagec

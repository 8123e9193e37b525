#include "axis_block.hpp"
#include <algorithm>

namespace stagec {
namespace {

std::string flat(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

bool has_axis_part(const std::string& word) { return other_axis(word) != word; }

bool names(const std::string& text, const Words& locals) {
    bool found = false;
    for_each_word(text, [&](const std::string& word, std::size_t at) {
        found |= locals.count(word) != 0 && (at == 0 || text[at - 1] != '.');
    });
    return found;
}

bool differs(const std::string& text, const Words& locals) { return tidy(other_axis(text)) != tidy(text) || names(text, locals); }

// The locals get the axis as suffix.
std::string for_axis(const std::string& text, const Words& locals, const std::string& suffix) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::string word = word_at(text, at);
        const bool member = at > 0 && text[at - 1] == '.';
        out += word.empty() ? std::string(1, text[at]) : word + (!member && locals.count(word) ? suffix : "");
        at += word.empty() ? 1 : word.size();
    }
    return out;
}

} // namespace

std::string renamed(const std::string& text, const std::map<std::string, std::string>& parts) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::string word = word_at(text, at);
        if (word.empty()) {
            out += text[at++];
            continue;
        }
        at += word.size();
        for (std::size_t from = 0; from <= word.size();) {
            const std::size_t end = std::min(word.find('_', from), word.size());
            const std::string part = word.substr(from, end - from);
            const auto found = parts.find(part);
            out += (found == parts.end() ? part : found->second) + (end < word.size() ? "_" : "");
            from = end + 1;
        }
    }
    return out;
}

std::string tidy(const std::string& text) {
    std::string out;
    for (const char c : flat(text))
        if (c != ' ' || (!out.empty() && out.back() != ' ')) out += c;
    while (!out.empty() && out.back() == ' ') out.pop_back();
    return out;
}

std::string other_axis(const std::string& text) {
    static const std::map<std::string, std::string> parts = {{"x", "y"},          {"y", "x"},         {"xx", "yy"}, {"yy", "xx"},
                                                             {"i", "j"},          {"j", "i"},         {"nx", "ny"}, {"ny", "nx"},
                                                             {"columns", "rows"}, {"rows", "columns"}};
    const Source swapped{"", renamed(text, parts)};
    std::string out;
    for (std::size_t at = 0; at < swapped.text.size();) {
        const std::string word = word_at(swapped.text, at);
        if (word != "IDX") {
            const std::size_t step = word.empty() ? 1 : word.size();
            out += swapped.text.substr(at, step);
            at += step;
            continue;
        }
        const std::size_t open = skip_blanks(swapped.text, at + word.size()), end = behind_bracket(swapped, open) - 1;
        int depth = 0;
        std::size_t comma = open + 1;
        while (comma < end && (depth != 0 || swapped.text[comma] != ',')) {
            depth += swapped.text[comma] == '(' ? 1 : swapped.text[comma] == ')' ? -1 : 0;
            ++comma;
        }
        const std::size_t second = std::min(skip_blanks(swapped.text, comma + 1), end);
        out += "IDX(" + swapped.text.substr(second, end - second) + ", " + swapped.text.substr(open + 1, comma - open - 1) + ")";
        at = end + 1;
    }
    return out;
}

AxisBlock::AxisBlock(const Source& source, std::size_t begin, std::size_t end, const ChangingFunctions& changing)
    : source_(source), changing_(changing) {
    split(begin, end);
}

bool AxisBlock::find_locals(const Words& declared, Words& locals) const {
    const std::size_t before = locals.size();
    for (const auto& piece : pieces_) {
        if (!piece.statement || !differs(piece.text, locals)) continue;
        for (const auto& name : changed_by(piece, declared)) {
            if (!declared.count(name)) continue;
            if (has_axis_part(name))
                source_.fail(piece.at, name + " has an axis in its name; in EACH_AXIS locals get one by themselves");
            locals.insert(name);
        }
    }
    return locals.size() != before;
}

std::string AxisBlock::text(const Words& locals) const {
    std::string out;
    bool any = false;
    for (const auto& piece : pieces_) {
        if (!differs(piece.text, locals)) {
            out += piece.text;
        } else if (!piece.statement) {
            source_.fail(piece.at, "the condition is another for each axis: select inside the block");
        } else {
            any = true;
            const std::size_t begin = skip_blanks(piece.text, 0);
            const std::string statement = piece.text.substr(begin);
            out += piece.text.substr(0, begin) + flat(for_axis(statement, locals, "_x")) + " " +
                   for_axis(other_axis(statement), locals, "_y");
        }
    }
    if (!any) source_.fail(pieces_.empty() ? 0 : pieces_.front().at, "nothing in EACH_AXIS is another for each axis");
    return out;
}

void AxisBlock::split(std::size_t begin, std::size_t end) {
    const std::string& text = source_.text;
    for (std::size_t at = begin; at < end;) {
        const std::size_t first = skip_blanks(text, at);
        if (first >= end) {
            pieces_.push_back({text.substr(at, end - at), first});
            break;
        }
        const std::string word = word_at(text, first);
        std::size_t stop = 0;
        bool statement = false;
        if (text[first] == '{' || text[first] == '}') {
            stop = first + 1;
        } else if (text[first] == '#') {
            source_.fail(first, "no preprocessor lines in EACH_AXIS");
        } else if (word == "else") {
            stop = first + word.size();
            const std::size_t next = skip_blanks(text, stop);
            if (text[next] != '{' && word_at(text, next) != "if") source_.fail(first, "braces behind else in EACH_AXIS");
        } else if (word == "return") {
            source_.fail(first, "no return in EACH_AXIS");
        } else if (word == "if" || word == "for") {
            stop = behind_bracket(source_, skip_blanks(text, first + word.size()));
            if (text[skip_blanks(text, stop)] != '{') { // its one statement goes with the condition
                stop = statement_end(skip_blanks(text, stop));
                statement = true;
            }
        } else {
            stop = statement_end(first);
            statement = true;
            note_declared(first, stop);
        }
        pieces_.push_back({text.substr(at, stop - at), first, statement});
        at = stop;
    }
}

std::size_t AxisBlock::statement_end(std::size_t at) const {
    const std::string& text = source_.text;
    while (at < text.size() && text[at] != ';') {
        if (text[at] == '{' || text[at] == '}') source_.fail(at, "a brace where a statement's ; was expected");
        at = text[at] == '(' || text[at] == '[' ? behind_bracket(source_, at) : at + 1;
    }
    return at + 1;
}

// "type name = ...;" or "type name;"
void AxisBlock::note_declared(std::size_t begin, std::size_t end) {
    const std::string& text = source_.text;
    std::string type = word_at(text, begin);
    std::size_t at = skip_blanks(text, begin + type.size());
    if (type == "const") at = skip_blanks(text, at + word_at(text, at).size());
    const std::string name = word_at(text, at);
    if (type.empty() || name.empty() || at >= end) return;
    const char next = text[skip_blanks(text, at + name.size())];
    if (next != '=' && next != ';' && next != ',') return;
    for (std::size_t n = at; n < end;
         n = std::string("([").find(text[n]) != std::string::npos ? behind_bracket(source_, n) : n + 1)
        if (text[n] == ',') source_.fail(n, "one declaration a statement in EACH_AXIS");
    declared_.insert(name);
}

// What a statement assigns or hands to a function that changes it.
Words AxisBlock::changed_by(const Piece& piece, const Words& declared) const {
    Words changed;
    const std::string& text = piece.text;
    for_each_word(text, [&](const std::string& word, std::size_t at) {
        const std::size_t behind = at + word.size();
        std::size_t next = skip_blanks(text, behind);
        while (next < text.size() && text[next] == '.') { // a member
            next = skip_blanks(text, next + 1);
            next = skip_blanks(text, next + word_at(text, next).size());
        }
        const std::string two = next < text.size() ? text.substr(next, 2) : "";
        if (two.empty()) return;
        const bool assigned = (two[0] == '=' && two != "==") ||
                              (two.size() == 2 && two[1] == '=' && std::string("+-*/").find(two[0]) != std::string::npos);
        if (assigned && (at == 0 || text[at - 1] != '.')) changed.insert(word);
        if (two[0] == ';' && declared.count(word)) changed.insert(word);
        const auto function = changing_.find(word);
        if (function == changing_.end() || two[0] != '(') return;
        const auto given = arguments({source_.path, text}, behind);
        for (const std::size_t n : function->second)
            if (n < given.size()) changed.insert(word_at(given[n], 0));
    });
    return changed;
}

} // namespace stagec

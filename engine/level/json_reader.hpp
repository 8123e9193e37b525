// Reads JSON objects key by key and keeps the first error, with the path of the field, what was found and what is allowed.
#pragma once
#include "engine/compute/status.hpp"
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace wadi {

using Json = nlohmann::json;

/// Parses JSON with // and /* */ comments and with texts in double or single quotes. Errors give line and column; a key given
/// twice is an error, and so are more than 32 lists and objects within each other.
Result<Json> parse_json(const std::string& given);

/// A value as a message shows it: at most 40 characters.
std::string json_text(const Json& value);

/// A bound where validate() knows the range.
inline constexpr double ANY_NUMBER = std::numeric_limits<double>::max();

/// One JSON object. Getters leave `out` as it is when the key is absent; after the first error they do nothing.
/// finish() then refuses keys that nobody asked for and required keys that were not there.
class ObjectReader {
  public:
    /// `path` is empty for the root; `status` collects the first error of the whole level.
    ObjectReader(const Json& value, std::string path, Status& status);

    /// The value of a key, or null when absent.
    const Json* find(const char* key);
    /// The same for a key that must be there.
    const Json* require(const char* key);
    std::string path_of(const std::string& key) const;
    void fail(const std::string& key, const std::string& message);
    bool failed() const { return !*status_; }
    Status& status() { return *status_; }

    void number(const char* key, double& out, double least, double most);
    /// The same for a key that must be there.
    void required_number(const char* key, double& out, double least, double most);
    void whole_number(const char* key, int& out, int least, int most);
    void boolean(const char* key, bool& out);
    void string(const char* key, std::string& out);
    /// A point or vector of two numbers.
    void pair(const char* key, std::array<double, 2>& out, double least, double most);
    /// The index of one of `names`; `index` stays when the key is absent.
    void choice(const char* key, const std::vector<std::string>& names, int& index);
    void finish();

  private:
    const Json* object_ = nullptr; // null when the value is no object
    std::string path_;
    Status* status_;
    std::vector<std::string> known_;
    std::string missing_; // first required key that was absent
};

/// One number at `path`, or an error in `status`.
double read_number(const Json& value, const std::string& path, double least, double most, Status& status);
std::array<double, 2> read_pair(const Json& value, const std::string& path, double least, double most, Status& status);

/// The elements of an array at `path`; empty, with an error in `status`, when it is none or longer than `most`.
std::vector<const Json*> read_array(const Json& value, const std::string& path, std::size_t most, Status& status);

} // namespace wadi

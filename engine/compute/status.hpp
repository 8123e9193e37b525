// Errors without exceptions: a Status code with a message, and Result<T> = value or Status.
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace wadi {

enum class Code {
    ok = 0,
    bad_argument,  // the caller's value is wrong; the message names it and the allowed range
    not_found,     // a file, level, backend or device is not there
    bad_file,      // a file is there but malformed; the message names the field or byte
    not_supported, // this build or device cannot do it
    out_of_memory, // host or device memory
    device_lost,   // sticky: every later call on the device returns it
    internal,      // our own bug
    not_ready,     // not an error: ask again later
    busy,          // another thread is inside a call on the same world
    cancelled,     // not an error: the host's progress callback ended the call
};

/// The name of a code as it is printed: "bad_argument" and so on.
const char* code_name(Code code);

struct [[nodiscard]] Status {
    Code code = Code::ok;
    std::string message;
    explicit operator bool() const { return code == Code::ok; }
};

inline Status ok_status() { return {}; }
inline Status error(Code code, std::string message) { return {code, std::move(message)}; }

/// A value, or the Status that says why there is none.
template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::move(value)) {}
    Result(Status status) : content_(std::move(status)) {}
    explicit operator bool() const { return content_.index() == 0; }
    T& value() { return std::get<0>(content_); }
    const T& value() const { return std::get<0>(content_); }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    Status status() const { return *this ? ok_status() : std::get<1>(content_); }

  private:
    std::variant<T, Status> content_;
};

} // namespace wadi

// What differs between operating systems.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace common {

/// Whether standard error is a terminal that understands carriage return.
bool error_stream_is_terminal();

/// The running program's file; empty where the system does not tell.
std::filesystem::path executable_path();

/// The file that runs a program of this name, from the folders in PATH; empty where there is none.
std::filesystem::path find_program(const std::string& name);

/// Runs a program of PATH with its arguments, the name first, and waits for it: its exit code, or -1 where it could not be
/// started or was ended.
int run_program(const std::vector<std::string>& arguments);

/// A library that is opened at run time and stays open.
class SharedLibrary {
  public:
    /// The first of these files that can be opened; false where none can.
    bool open(const std::vector<const char*>& names);
    /// A function of it; false where it lacks one of that name.
    template <typename F> bool find(const char* name, F*& function) const {
        function = reinterpret_cast<F*>(address(name));
        return function != nullptr;
    }

  private:
    void (*address(const char* name) const)();
    void* handle_ = nullptr;
};

/// The first interrupt (Ctrl-C) only sets the flag, a second one ends the program.
void catch_interrupt();
bool interrupted();

} // namespace common

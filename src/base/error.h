#pragma once

#include <stdexcept>
#include <string>

namespace lumulus {

/// An error that a person has to see, as one line: `<what> (<where>): <how to mend>`.
/// `where` is a file or a key. The parts are kept separate so that a service can send them to its client.
class Error : public std::runtime_error {
  public:
    Error(std::string what, std::string where, std::string mend)
        : std::runtime_error(what + (where.empty() ? "" : " (" + where + ")") + (mend.empty() ? "" : ": " + mend)) {}

    /// Exit code of a process that ends with this error.
    virtual int exitCode() const { return 1; }
};

/// An error in the usage or the input; its exit code is 2.
class InputError : public Error {
  public:
    using Error::Error;
    int exitCode() const override { return 2; }
};

}  // namespace lumulus

#pragma once

#include <stdexcept>
#include <string>

namespace lumulus {

/// An error that a person has to see, as one line: `<what> (<where>): <how to mend>`.
/// `where` is a file or a key; the parts stay separate so that a service can send them on.
class Error : public std::runtime_error {
  public:
    Error(std::string what, std::string where, std::string mend)
        : std::runtime_error(what + (where.empty() ? "" : " (" + where + ")") + (mend.empty() ? "" : ": " + mend)) {}

    /// Exit code of the process that ends with this error.
    virtual int exitCode() const { return 1; }
};

/// Bad usage or bad input: exit code 2.
class InputError : public Error {
  public:
    using Error::Error;
    int exitCode() const override { return 2; }
};

}  // namespace lumulus

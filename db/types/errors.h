// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace phonomime {

// The classes of failure, numbered as the program's exit status.
enum class ErrorClass {
  usage = 2,        // the call's words are off
  bad_input = 3,    // a file or a value that the user gave is wrong
  io = 4,           // a file cannot be read or written
  internal = 5,     // a defect of this program
  interrupted = 130 // stopped by the user
};

// What a person needs to mend a failure. Empty fields are left out of the message.
struct ErrorDetails {
  std::string where = {};    // file, with line or time where known: "u17.lab:12"
  std::string what = {};     // one clause, no full stop: `phoneme "axx" is not in set festival_us`
  std::string expected = {}; // what would have been right
  std::string got = {};      // what was there
  std::string remedy = {};   // what to do, a whole sentence: `Did you mean "ax"?`
};

// "where: what (expected E, got G). Remedy"
std::string format_error(const ErrorDetails& details);

// The one base of everything that Phonomime throws on purpose. Libraries throw; tools/ catches
// once.
class Error : public std::runtime_error {
public:
  Error(ErrorClass error_class, ErrorDetails details);
  ErrorClass error_class() const noexcept { return class_; }
  const ErrorDetails& details() const noexcept { return details_; }

private:
  ErrorClass class_;
  ErrorDetails details_;
};

class UsageError : public Error {
public:
  explicit UsageError(ErrorDetails details) : Error(ErrorClass::usage, std::move(details)) {}
};

class InputError : public Error {
public:
  explicit InputError(ErrorDetails details) : Error(ErrorClass::bad_input, std::move(details)) {}
};

class IoError : public Error {
public:
  explicit IoError(ErrorDetails details) : Error(ErrorClass::io, std::move(details)) {}
};

class InternalError : public Error {
public:
  explicit InternalError(ErrorDetails details) : Error(ErrorClass::internal, std::move(details)) {}
};

class Interrupted : public Error {
public:
  Interrupted() : Error(ErrorClass::interrupted, {.what = "interrupted"}) {}
};

// "path:line"
std::string at_line(std::string_view path, long line);

} // namespace phonomime

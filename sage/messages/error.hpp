// Errors that a user can act on.  Diagnostics carry a place in the deck; exceptions carry diagnostics.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "sage/messages/code.hpp"

namespace sage {

// A place in an input file.  line and columns count from 1; 0 = unknown.  Columns are inclusive.
struct SourcePosition {
  std::string file;
  int line = 0;
  int first_column = 0;
  int last_column = 0;
};

// "deck.dat:41:11-20", "deck.dat:41" or "deck.dat".
std::string to_string(const SourcePosition& where);

enum class Severity { note, warning, error };

struct Diagnostic {
  Severity severity = Severity::error;
  Code code;  // what `sagefe explain` says more about
  SourcePosition where;
  std::string message;              // what is wrong and what was expected
  std::vector<std::string> detail;  // lines shown below: the card, carets, notes
};

// "deck.dat:41:11-20: error: message [S104]" and the detail lines below it.
std::string to_string(const Diagnostic& diagnostic);

// Collects diagnostics so that one pass shows every mistake.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic);
  void error(Code code, SourcePosition where, std::string message);
  void warning(Code code, SourcePosition where, std::string message);
  void note(Code code, SourcePosition where, std::string message);

  int errors() const { return errors_; }
  int warnings() const { return warnings_; }
  const std::vector<Diagnostic>& list() const { return list_; }

 private:
  std::vector<Diagnostic> list_;
  int errors_ = 0;
  int warnings_ = 0;
};

// The input can't be used (exit code 2).  Carries everything found wrong.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Diagnostics diagnostics);
  InputError(Code code, SourcePosition where, const std::string& message);
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  Diagnostics diagnostics_;
};

// A message that names no place in a file.  what() is the message without its code.
class CodedError : public std::runtime_error {
 public:
  CodedError(Code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Code code() const { return code_; }

 private:
  Code code_;
};

// The code of an exception: its own, or what those of the library have in common ("S508", no memory or an array
// beyond what can be addressed; "S513", everything else).
Code code_of(const std::exception& error);
// What is printed of an exception: its message with the code.
std::string message_of(const std::exception& error);

// A law, element or solver refuses one of its parameters; the model builder adds the place in the deck.
class ParameterError : public CodedError {
 public:
  ParameterError(int parameter, const std::string& message) : ParameterError("S224", parameter, message) {}
  ParameterError(Code code, int parameter, const std::string& message)
      : CodedError(code, message), parameter_(parameter) {}
  int parameter() const { return parameter_; }  // index into the catalogue entry's parameters, -1 = as a whole

 private:
  int parameter_;
};

// An element whose shape can't be integrated; the model builder adds element number and deck place.
class ElementShapeError : public CodedError {
 public:
  explicit ElementShapeError(const std::string& message) : CodedError("S226", message) {}
};

// Thrown by LinearSolver::factorise.  `equation` is the one whose pivot vanished, -1 where the solver can't tell.
class SingularMatrix : public CodedError {
 public:
  SingularMatrix(int equation, double pivot_ratio, const std::string& message)
      : CodedError("S502", message), equation_(equation), pivot_ratio_(pivot_ratio) {}
  int equation() const { return equation_; }
  double pivot_ratio() const { return pivot_ratio_; }  // |pivot| / largest term of its row before elimination

 private:
  int equation_;
  double pivot_ratio_;
};

// The analysis could not go on (exit code 3).  What was computed before stays written.
class AnalysisError : public CodedError {
 public:
  using CodedError::CodedError;
  // Of a piece from outside of this program, such as a solver of one's own.
  explicit AnalysisError(const std::string& message) : CodedError("S510", message) {}
};

// A result file can't be written: full disk, missing rights, a folder that is a file.  The message names the
// file and the system's reason (exit code 4).
class OutputError : public CodedError {
 public:
  using CodedError::CodedError;
};

}  // namespace sage

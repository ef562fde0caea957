// Errors that a user can act on.  Diagnostics carry a place in the deck; exceptions carry diagnostics.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

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
  SourcePosition where;
  std::string message;              // what is wrong and what was expected
  std::vector<std::string> detail;  // lines shown below: the card, carets, notes
};

// "deck.dat:41:11-20: error: message" and the detail lines below it.
std::string to_string(const Diagnostic& diagnostic);

// Collects diagnostics so that one pass shows every mistake.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic);
  void error(SourcePosition where, std::string message);
  void warning(SourcePosition where, std::string message);
  void note(SourcePosition where, std::string message);

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
  InputError(SourcePosition where, const std::string& message);
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  Diagnostics diagnostics_;
};

// A law, element or solver refuses one of its parameters; the model builder adds the place in the deck.
class ParameterError : public std::runtime_error {
 public:
  ParameterError(int parameter, const std::string& message)
      : std::runtime_error(message), parameter_(parameter) {}
  int parameter() const { return parameter_; }  // index into the catalogue entry's parameters, -1 = as a whole

 private:
  int parameter_;
};

// An element whose shape can't be integrated; the model builder adds element number and deck place.
class ElementShapeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Thrown by LinearSolver::factorise.  `equation` is the one whose pivot vanished, -1 where the solver can't tell.
class SingularMatrix : public std::runtime_error {
 public:
  SingularMatrix(int equation, double pivot_ratio, const std::string& message)
      : std::runtime_error(message), equation_(equation), pivot_ratio_(pivot_ratio) {}
  int equation() const { return equation_; }
  double pivot_ratio() const { return pivot_ratio_; }  // |pivot| / largest term of its row before elimination

 private:
  int equation_;
  double pivot_ratio_;
};

// The analysis could not go on (exit code 3).  What was computed before stays written.
class AnalysisError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A result file can't be written: full disk, missing rights, a folder that is a file.  The message names the
// file and the system's reason (exit code 4).
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sage

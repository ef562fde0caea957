#include "sage/deck/other_programs.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "sage/deck/text.hpp"
#include "sage/messages/parse_number.hpp"

namespace sage {

namespace {

constexpr std::size_t kLargestText = 4'000'000;

// How a program reads its deck.  Items: i integer, r real, t text, n node number, c code 0 or 1, / a new READ,
// {...} a group; `:name` keeps an integer, `*expression` repeats, `?expression` before a group reads it where that
// is not 0.  Record orders: the programs' own READ statements, 5th edition.
struct Program {
  const char *number, *what, *reads;
};

#define SAGE_TYPES(elements) "?np>1{ / i*" elements " } "
#define SAGE_FIXED "/ i:nf ?nf>0{ / { n i r }*nf } "
#define SAGE_POTENTIALS "/ i:nl { n r }*nl / i:nf ?nf>0{ / { n r }*nf } "
#define SAGE_HELD "/ i:nf ?nf>0{ / { n r }*nf } "
#define SAGE_BRICKS       \
  "/ r*2*np " SAGE_TYPES( \
      "nxe*nye*nze") "/ r*nxe+nye+nze+3 / i:nr { n c c c }*nr / i:nl { n r r r }*nl " SAGE_FIXED
#define SAGE_FRAME \
  "i:nels i:nn i:nd i:npr i:np / r*npr*np " SAGE_TYPES("nels") "?nd=3{ / r*nels } / r*nd*nn / i*2*nels "        \
  "/ i:nr { n c*(nd=1)*2+(nd>1)*(3*nd-3) }*nr "
#define SAGE_RECTANGLE(properties, more) \
  "i:nxe i:nye i:np / r*" properties "*np" more " " SAGE_TYPES("nxe*nye") "/ r*nxe+nye+2 "

constexpr Program kPrograms[] = {
    {"4.1", "rods", "i:nels i:np / r*np " SAGE_TYPES("nels") "/ r*nels / i:nr { n c }*nr " SAGE_POTENTIALS},
    {"4.2", "pin-jointed frames",
     "i:nels i:nn i:nd i:np / r*np " SAGE_TYPES("nels") "/ r*nd*nn / i*2*nels / i:nr { n c*nd }*nr "
                                                        "/ i:nl { n r*nd }*nl " SAGE_FIXED},
    {"4.3", "beams",
     "i:nels i:npr i:np / r*npr*np " SAGE_TYPES(
         "nels") "/ r*nels / i:nr { n c c }*nr / i:nl { n r r }*nl " SAGE_FIXED},
    {"4.4", "rigid-jointed frames", SAGE_FRAME "/ i:nl { n r*3*nd-3 }*nl " SAGE_FIXED},
    {"4.5", "elastic-plastic beams and frames",
     SAGE_FRAME "/ i:nl / { n r*(nd=1)*2+(nd>1)*(3*nd-3) }*nl / i r i:incs / r*incs "},
    {"4.6", "buckling of beams",
     "i:nels i:npr i:np / r*npr*np " SAGE_TYPES("nels") "/ r*nels / i:nr { n c c }*nr i r "},
    {"4.7", "plates in bending",
     "i:nxe i:nye i:np r r r / r*2*np " SAGE_TYPES(
         "nxe*nye") "/ i:nr { n c c c c }*nr / i:nl { n r r r r }*nl " SAGE_FIXED},
    {"5.3", "three-dimensional solids", "i:nod i:nxe i:nye i:nze i:nip i:np " SAGE_BRICKS},
    {"5.6 or 5.7", "three-dimensional solids", "i:nod i:nxe i:nye i:nze i:nip r i i:np " SAGE_BRICKS},
    {"6.12", "three-dimensional slopes",
     "r r r r r r i:nxa i:nxb i:nya i:nyb i:nze i i:np / r*6*np " SAGE_TYPES(
         "(nxa*(nya+nyb)+nyb*nxb)*nze") "/ r i i:ns / r*ns "},
    {"7.1", "steady seepage along a line",
     "i:nels i:nn i:np / r*np " SAGE_TYPES("nels") "/ r*nels / i*2*nels " SAGE_POTENTIALS},
    {"7.3", "seepage with a free surface",
     "i:nxe i:nye r i i:np / r*2*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+1 / r*nxe+1 / r / r i:nu / i*nu / r i:nv / i*nv / i "},
    {"7.4", "steady seepage",
     "t i:nod i:nels i:nn i:nip i:nd i:np / r*nd*np " SAGE_TYPES(
         "nels") "/ r*nd*nn / i*nod*nels " SAGE_POTENTIALS "?(nd=2)*(nod=4){ / i } "},
    {"7.5", "steady seepage",
     "t i:nod i:nels i:nn i:nip i:nd r i i:np / r*nd*np " SAGE_TYPES(
         "nels") "/ r*nd*nn / i*nod*nels " SAGE_POTENTIALS "?(nd=2)*(nod=4){ / i } "},
    {"8.1", "consolidation along a line",
     "i:nels i:np / r*np " SAGE_TYPES("nels") "/ r*nels / r i r i i i / r*nels+1 " SAGE_HELD},
    {"8.2", "consolidation along a line",
     "i:nels i:np / r*2*np r " SAGE_TYPES("nels") "/ r*nels r i r i i i / r*nels+1 " SAGE_HELD},
    {"8.3", "consolidation along a line, explicit",
     "i:nels i:np / r*np " SAGE_TYPES("nels") "/ r*nels r i i i i / r*nels+1 " SAGE_HELD},
    {"8.4, 8.5 or 8.7", "heat or consolidation",
     "t t i:nxe i:nye i:np / r*2*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 / r i r i i i / r*(nxe+1)*(nye+1) " SAGE_HELD "/ i "},
    {"8.6", "consolidation, explicit",
     "t t i:nxe i:nye i:np / r*2*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 / r i i i i / r*(nxe+1)*(nye+1) " SAGE_HELD "/ i "},
    {"8.8", "consolidation",
     "t i:nels i:nn i:nip i:nod i:nd i:np / r*nd*np " SAGE_TYPES(
         "nels") "/ r*nd*nn / i*nod*nels / r i r i i ?(nd=2)*(nod=4){ / i i } / r*nn " SAGE_HELD},
    {"8.9", "diffusion and convection", SAGE_RECTANGLE("2", "") "/ r i r i i i r r i "},
    {"8.10", "diffusion and convection", SAGE_RECTANGLE("2", "") "/ r i r i i i r r / i:nf / n*nf "},
    {"8.11", "heat",
     "t t i:nxe i:nye i:np / r*3*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 / r i r i i i / i:nl { n r }*nl / i:nr ?nr>0{ / { n n r r }*nr } "
                    "/ r*(nxe+1)*(nye+1) " SAGE_HELD "/ i "},
    {"9.1", "flow of a viscous fluid",
     "i:nxe i:nye r i r r / r*nxe+nye+2 / i:nr { n c c c }*nr / i:nf / { n i r }*nf "},
    {"9.2", "flow of a viscous fluid",
     "i:nxe i:nye r i r r r i r i r / r*nxe+nye+2 / i:nr { n c c c }*nr / i:nf / { n i r }*nf "},
    {"9.3", "coupled consolidation along a line",
     "i:nels i:np / r*2*np " SAGE_TYPES(
         "nels") "/ r*nels / r i r i i i / i:nr { n c c }*nr / i:nl / { n r }*nl / i:nt / r*2*nt "},
    {"10.1", "natural frequencies of beams",
     "i:nels i:np / r*2*np " SAGE_TYPES("nels") "/ r*nels / i:nr { n c c }*nr / i "},
    {"10.2", "natural frequencies",
     "i:nxe i:nye i:nod i:np / r*3*np " SAGE_TYPES("nxe*nye") "/ r*nxe+nye+2 / i:nr { n c c }*nr / i "},
    {"10.3", "natural frequencies",
     "i:nxe i:nye i:nod i:np / r*3*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 / i:nr { n c c }*nr / i r r i i i i r "},
    {"10.4", "natural frequencies",
     "i:nxe i:nye i:nod i:np / r*3*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 / i:nr { n c c }*nr / i i t t r i "},
    {"11.1", "vibration of beams",
     "i:nels i:np / r*2*np " SAGE_TYPES(
         "nels") "/ r*nels r r r r r / i:nr { n c c }*nr / i:nt { / n i i:np / r*2*np }*nt "
                 "/ i:no / { n i }*no "},
    {"11.2", "vibration by modes",
     "i:nxe i:nye i:nod i:np / r*3*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 r i i i r / i:nr { n c c }*nr / i r "},
    {"11.3 or 11.4", "forced vibration",
     SAGE_RECTANGLE("3", "") "r i r i i r r / i:nr { n c c }*nr / i:nl / { n r r }*nl "},
    {"11.5", "forced vibration", SAGE_RECTANGLE("4", "") "r i i i / i:nr { n c c }*nr "},
    {"11.6", "forced vibration", SAGE_RECTANGLE("3", "") "r i r r i i / i:nr { n c c }*nr / t*nxe*nye "},
    {"11.7", "forced vibration",
     "i:nxe i:nye r i i:np / r*3*np " SAGE_TYPES(
         "nxe*nye") "/ r*nxe+nye+2 r i r i i r r / i:nr { n c c }*nr / i:nl / { n r r }*nl "},
    {"11.8", "forced vibration, elastic-plastic",
     SAGE_RECTANGLE("4", "") "r i i i / i:nr { n c c }*nr / i:nl / { n r r }*nl "},
};

#undef SAGE_TYPES
#undef SAGE_FIXED
#undef SAGE_POTENTIALS
#undef SAGE_HELD
#undef SAGE_BRICKS
#undef SAGE_FRAME
#undef SAGE_RECTANGLE

struct Token {
  std::string_view text;
  int line = 0;
  bool quoted = false;
};

// Values as a list-directed READ separates them; no repeat counts or nulls, which those decks do not have.
std::vector<Token> tokens_of(const SourceText& source) {
  std::vector<Token> all;
  for (int n = 1; n <= source.line_count(); ++n) {
    const std::string_view line = source.line(n);
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t,", at)) != std::string_view::npos) {
      const bool quoted = line[at] == '\'' || line[at] == '"';
      std::size_t end = quoted ? line.find(line[at], at + 1) : line.find_first_of(" \t,", at);
      end = end == std::string_view::npos ? line.size() : end + (quoted ? 1 : 0);
      all.push_back({line.substr(at, end - at), n, quoted});
      at = end;
    }
  }
  return all;
}

std::optional<double> number_of(std::string_view text, bool integer) {
  std::string plain(text);
  if (!plain.empty() && plain[0] == '+') plain.erase(0, 1);
  for (char& c : plain) c = c == 'D' || c == 'd' ? 'E' : c;
  const std::optional<double> value = parse_number<double>(plain);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  if (integer && plain.find_first_of(".Ee") != std::string::npos) return std::nullopt;
  return value;
}

// + - * = > and brackets over names and numbers.
class Counts {
 public:
  std::map<std::string, double, std::less<>> names;

  double value(std::string_view text) {
    text_ = text;
    at_ = 0;
    return compared();
  }

 private:
  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  double compared() {
    const double left = sum();
    if (take('=')) return left == sum() ? 1.0 : 0.0;
    if (take('>')) return left > sum() ? 1.0 : 0.0;
    return left;
  }
  double sum() {
    double total = product();
    while (true) {
      if (take('+'))
        total += product();
      else if (take('-'))
        total -= product();
      else
        return total;
    }
  }
  double product() {
    double total = factor();
    while (take('*')) total *= factor();
    return total;
  }
  double factor() {
    if (take('(')) {
      const double inside = compared();
      take(')');
      return inside;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (const auto found = names.find(word); found != names.end()) return found->second;
    return number_of(word, true).value_or(0.0);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class Match {
 public:
  explicit Match(const std::vector<Token>& tokens) : tokens_(tokens) {}
  bool whole(std::string_view reads) { return run(reads) && at_ == tokens_.size(); }

 private:
  static std::string_view word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::string_view found = text.substr(0, text.find_first_of(" {"));
    text.remove_prefix(found.size());
    return found;
  }
  // Up to the bracket that closes the one that `text` begins with; `text` goes on behind it.
  static std::string_view group(std::string_view& text) {
    int depth = 0;
    std::size_t end = 0;
    do depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
    while (++end < text.size() && depth > 0);
    const std::string_view inside = text.substr(1, end - 2);
    text.remove_prefix(end);
    return inside;
  }

  bool run(std::string_view reads) {
    while (true) {
      std::string_view item = word(reads);
      if (item.empty() && (reads.empty() || reads[0] != '{')) return true;
      if (item == "/") {
        if (at_ > 0 && at_ < tokens_.size() && tokens_[at_].line == tokens_[at_ - 1].line) return false;
        continue;
      }
      double times = 1.0;
      if (reads.starts_with('{') && (item.empty() || item[0] == '?')) {
        const std::string_view inside = group(reads);
        if (!item.empty()) times = counts_.value(item.substr(1)) != 0.0 ? 1.0 : 0.0;
        if (reads.starts_with('*')) times = counts_.value(word(reads).substr(1));
        if (!repeated(times, [&] { return run(inside); })) return false;
        continue;
      }
      if (item.size() > 2 && item[1] == '*') times = counts_.value(item.substr(2));
      const std::string_view name = item.size() > 2 && item[1] == ':' ? item.substr(2) : std::string_view();
      if (!repeated(times, [&] { return take(item[0], name); })) return false;
    }
  }

  template <class Once>
  bool repeated(double times, const Once& once) {
    if (!(times >= 0.0 && times <= 1e7)) return false;
    for (long i = 0; i < std::lround(times); ++i)
      if (!once()) return false;
    return true;
  }

  bool take(char kind, std::string_view name) {
    if (at_ == tokens_.size()) return false;
    const Token& token = tokens_[at_++];
    if (kind == 't') return token.quoted || std::isalpha(static_cast<unsigned char>(token.text[0])) != 0;
    if (token.quoted) return false;
    const std::optional<double> value = number_of(token.text, kind != 'r');
    if (!value || (kind == 'c' && *value != 0.0 && *value != 1.0) || (kind == 'n' && *value < 1.0))
      return false;
    if (!name.empty()) counts_.names.insert_or_assign(std::string(name), *value);
    // Sizes of a mesh are positive.
    return name.empty() || *value >= (name == "nr" || name == "nl" || name == "nf" ? 0.0 : 1.0);
  }

  const std::vector<Token>& tokens_;
  std::size_t at_ = 0;
  Counts counts_;
};

}  // namespace

std::string other_program(const SourceText& source) {
  if (source.text()->size() > kLargestText) return {};
  const std::vector<Token> tokens = tokens_of(source);
  if (tokens.size() < 5) return {};
  for (const Program& program : kPrograms)
    if (Match(tokens).whole(program.reads))
      return "program " + std::string(program.number) + " of Smith and Griffiths: " + program.what;
  return {};
}

}  // namespace sage

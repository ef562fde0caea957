// Laws by catalogue entry and named parameters, as the command line and files of cases give them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sage/core/short_names.hpp"
#include "sage/drive/curve.hpp"
#include "sage/messages/error.hpp"

namespace sage::drive {

struct Setting {
  std::string key, value;
};

// "NAME=VALUE".  Throws InputError at `where`.
Setting setting_from(std::string_view text, const SourcePosition& where = {});

// A law by name or code with blank values: what is not set takes its fallback, what must be set is missing.
// Throws InputError with the laws that there are.
Subject subject_of(const Catalogue& catalogue, std::string_view law, const UnitSystem& units,
                   const SourcePosition& where = {});

// The same of "NAME:LAW"; NAME is the law's where there is none.  A user material finds its routine by it: CMNAME.
Subject named_subject(const Catalogue& catalogue, std::string_view text, const UnitSystem& units,
                      const SourcePosition& where = {});

// Sets a parameter, or the pressure or history.NAME at the start.  Throws InputError with the parameters that there are.
void apply(Subject& subject, const Setting& setting, const SourcePosition& where = {});

// Whether all is set that has to be, and the law takes it.  Throws InputError with name and what is wrong.
void expect_whole(const Subject& subject, const SourcePosition& where = {});

// "NAME:LAW,KEY=VALUE,..."; the law's name where there is no NAME.  base: a law and what is set already, for a
// text that names no law; nullptr = there is none.
Subject subject_from(const Catalogue& catalogue, std::string_view text, const UnitSystem& units,
                     double pressure, const Subject* base, const SourcePosition& where = {});

// A subject a line, as subject_from() takes them; # begins a comment.  Throws InputError.
std::vector<Subject> read_subjects(const Catalogue& catalogue, const std::filesystem::path& file,
                                   const UnitSystem& units, double pressure, const Subject* base);

// "drucker_prager: youngs_modulus = 3000 psi, ...".
std::string words_of(const Subject& subject);

}  // namespace sage::drive

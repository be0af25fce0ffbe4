#pragma once

#include "case_section.hpp"
#include "treacle/model/case.hpp"

namespace treacle {

/// The tables of a case file that say how to run it. `top`: the whole file. Errors: InputError.
TimeSettings readTime(const Section& top, double resolution);
MethodSettings readMethod(const Section& top);
SolverSettings readSolver(const Section& top, MethodKind method);
OutputSettings readOutput(const Section& top, MethodKind method);

/// Keys that only one method has, for the tables of the other.
ForeignKeys keysOf(MethodKind owner, const std::vector<std::string_view>& keys);

}  // namespace treacle

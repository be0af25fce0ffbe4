#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A change of the small case that makes it unusable, and the message that says so.
struct BadCase {
  const char* name;
  const char* from;
  const char* to;
  const char* message;
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.name; }

class BadInput : public testing::TestWithParam<BadCase> {};

TEST_P(BadInput, isRejectedWithPlaceAndReason) {
  const BadCase& bad = GetParam();
  Workshop shop;
  shop.put("bad.toml", replaced(smallCase, bad.from, bad.to));
  for (const char* command : {"check bad.toml", "run bad.toml"}) {
    const Outcome outcome = shop.call(command);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.err, StartsWith(std::string("treacle: error: ") + bad.message));
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(shop / "bad-run"));
  }
}

/// What a material of ISPH does not have; in its place, from line 16 on, a case can name the method.
constexpr const char* bulk = "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n";

constexpr BadCase badCases[] = {
    {"brokenToml", "max = [12e-3, 12e-3]", "max = [12e-3, 12e-3", "bad.toml:9:1: not valid TOML: "},
    {"keyTwice", "spacing = 1e-3", "spacing = 1e-3\nspacing = 2e-3", "bad.toml:4:"},
    {"unknownKey", "dynamic_viscosity", "dinamic_viscosity",
     "bad.toml:15:1: unknown key 'dinamic_viscosity' in [[material]] 'syrup'; did you mean 'dynamic_viscosity' "
     "[Pa s]?"},
    {"bareViscosity", "dynamic_viscosity", "viscosity",
     "bad.toml:15:1: unknown key 'viscosity' in [[material]] 'syrup'; did you mean 'dynamic_viscosity' [Pa s]?"},
    {"unknownKeyNearNone", "interval", "zzz",
     "bad.toml:40:1: unknown key 'zzz' in [output]; expected 'interval', 'checkpoint_interval', 'fields', "
     "'format', 'precision', 'compression', 'pieces', 'surface' or 'balance'"},
    {"surfaceInThePlane", "interval = 1e-3", "interval = 1e-3\nsurface = true",
     "bad.toml:41:11: surface in [output]: found true in two dimensions; surfaces are those of three"},
    {"unknownCompression", "interval = 1e-3", "interval = 1e-3\ncompression = \"lz4\"",
     "bad.toml:41:15: compression in [output]: expected 'zlib' or 'none', found 'lz4'"},
    {"unknownPieces", "interval = 1e-3", "interval = 1e-3\npieces = \"two\"",
     "bad.toml:41:10: pieces in [output]: expected 'auto', 'one' or 'each', found 'two'"},
    {"unknownTable", "[gravity]", "[gravty]",
     "bad.toml:9:2: unknown key 'gravty' in the case file; did you mean 'gravity'?"},
    {"keyOfAnotherShape", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nradius = 1",
     "bad.toml:26:1: unknown key 'radius' in [[body]] 'column' (box); expected 'name', 'type', 'material', "
     "'shape', 'where', 'subtract', 'velocity', 'disorder', 'viscosity_factor', 'state', 'min', 'max' or "
     "'transform'"},
    {"comparisonsInARow", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"0 < x < 1\"",
     "bad.toml:26:9: where in [[body]] 'column' (box): expected an expression in x, y [m] and the constant pi, "
     "found \"0 < x < 1\": two comparisons in a row; write \"a < x && x < b\" for a range"},
    {"conditionThatIsNoNumber", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"sqrt(-x)\"",
     "bad.toml:26:9: where in [[body]] 'column' (box): \"sqrt(-x)\" is not a number for the particle at (0.5, "
     "0.5) mm; expected a finite number"},
    {"conditionThatLeavesNothing", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"x > 1\"",
     "the case has no fluid: no body of type \"fluid\" holds a particle; 'column' is 0.006 m x 0.006 m large, of "
     "which where = \"x > 1\" leaves nothing, and the spacing is 0.001 m"},
    {"infiniteDisplacement", "max = [12e-3, 0]", "max = [12e-3, 0]\ndisplacement = [\"1/t\", 0]",
     "bad.toml:34:16: displacement in [[body]] 'floor' (box): \"1/t\" is infinite at t = 0 s; expected a finite "
     "number"},
    {"displacementThatEndsInTheRun", "max = [12e-3, 0]", "max = [12e-3, 0]\ndisplacement = [\"sqrt(1e-3-t)\", 0]",
     "bad.toml:34:16: displacement in [[body]] 'floor' (box): \"sqrt(1e-3-t)\" is not a number at t = 0.001002 s"},
    {"infiniteGravity", "acceleration = [0, -10]", "acceleration = [0, \"-1/t\"]",
     "bad.toml:10:16: acceleration in [gravity]: \"-1/t\" is infinite at t = 0 s; expected a finite number"},
    {"noTableFile", "max = [12e-3, 0]", "max = [12e-3, 0]\ndisplacement = [{file = \"nope.csv\"}, 0]",
     "bad.toml:34:16: displacement in [[body]] 'floor' (box): /"},
    {"lineBesideTheDomain", "[output]",
     "[[probe]]\nname = \"l\"\ntype = \"line\"\nfrom = [1, 0]\nto = [2, 0]\n\n[output]",
     "bad.toml:42:8: from in [[probe]] 'l' (line): expected a line through the domain, (-4, -4) mm to (12, 12) "
     "mm, found (1, 0) m to (2, 0) m"},
    {"bodyOutOfAWideDomain", "max = [12e-3, 12e-3]", "max = [2, 5e-3]",
     "body 'column' reaches out of the domain: a particle at (0.5, 5.5) mm, the domain is (-0.004, -0.004) m to "
     "(2, 0.005) m"},
    {"stateOfUnknownLaw", "density = 1000", "density = 1000\nstate = [{ name = \"cure\", law = \"kamal\" }]",
     "bad.toml:15:33: law in [[state]] 'cure': expected 'expression', 'kamal-sourour', 'houska' or "
     "'roussel', found 'kamal'"},
    {"stateWithoutRate", "density = 1000", "density = 1000\nstate = [{ name = \"cure\", law = \"expression\" }]",
     "bad.toml:15:10: rate in"},
    {"rateOfUnknownState", "density = 1000",
     "density = 1000\nstate = [{ name = \"a\", law = \"expression\", rate = \"b\" }]",
     "bad.toml:15:51: rate in [[state]] 'a' (expression): expected an expression in shear_rate, t, a and the "
     "constant "
     "pi, found \"b\": unknown name \"b\""},
    {"keyOfAnotherLaw", "density = 1000",
     "density = 1000\nstate = [{ name = \"a\", law = \"houska\", build_up = 1, break_down = 1, rate = \"b\" }]",
     "bad.toml:15:"},
    {"stateOfAFieldsName", "density = 1000",
     "density = 1000\nstate = [{ name = \"pressure\", law = \"expression\", rate = \"1\" }]",
     "bad.toml:15:19: name in"},
    {"stateThatIsNoName", "density = 1000",
     "density = 1000\nstate = [{ name = \"a b\", law = \"expression\", rate = \"1\" }]",
     "bad.toml:15:19: name in"},
    {"stateBeyondItsBounds", "density = 1000",
     "density = 1000\nstate = [{ name = \"a\", law = \"houska\", build_up = 1, break_down = 1, start = 2 }]",
     "bad.toml:15:78: start in [[state]] 'a' (houska): expected a number from 0 to 1, found 2"},
    {"curingWithoutHeat", "density = 1000",
     "density = 1000\nstate = [{ name = \"a\", law = \"kamal-sourour\", a1 = 1, e1 = 5e4 }]",
     "bad.toml:15:60: e1 in"},
    {"gelOfUnknownState", "density = 1000",
     "density = 1000\ngelling = { state = \"cure\", conversion = 0.6, a = 1 }",
     "bad.toml:15:21: state in the gelling of [[material]] 'syrup': unknown state 'cure' of the material"},
    {"yieldWithoutRheology", "density = 1000", "density = 1000\nyield_factor = \"2\"",
     "bad.toml:15:16: yield_factor in [[material]] 'syrup': the material has no rheology with a yield stress"},
    {"volumeOfUnknownName", "density = 1000", "density = 1000\nvolume_factor = \"1 + 1e-3*T\"",
     "bad.toml:15:17: volume_factor in [[material]] 'syrup': expected an expression in"},
    {"factorOfUnknownName", "density = 1000", "density = 1000\nviscosity_factor = \"T\"",
     "bad.toml:15:20: viscosity_factor in [[material]] 'syrup': expected an expression in"},
    {"bodyWithUnknownState", "shape = \"box\"", "shape = \"box\"\nstate = [{ name = \"cure\", value = 1 }]",
     "bad.toml:24:19: name in [[state]] 'cure': the material 'syrup' has no state 'cure'"},
    {"missingKey", "density = 1000\n", "",
     "bad.toml:12:1: density in [[material]] 'syrup': missing; expected a positive number [kg/m3]"},
    {"missingTable", "[time]\nstep = 1e-3\nend = 2e-3\n", "",
     "bad.toml:1:1: time in the case file: missing; "
     "expected a table [time]"},
    {"stringForNumber", "density = 1000", "density = \"1000\"",
     "bad.toml:14:11: density in [[material]] 'syrup': expected a positive number [kg/m3], found the string "
     "\"1000\""},
    {"numberForString", "type = \"fluid\"", "type = 1",
     "bad.toml:21:8: type in [[body]] 'column' (box): expected a string, found 1"},
    {"numberForVector", "max = [6e-3, 6e-3]", "max = 6e-3",
     "bad.toml:25:7: max in [[body]] 'column' (box): expected an array of 2 finite numbers [m], found 0.006"},
    {"vectorOfWrongLength", "acceleration = [0, -10]", "acceleration = [0, 0, -10]",
     "bad.toml:10:16: acceleration in [gravity]: expected an array of 2 of these: a finite number "
     "[m/s2], an expression in t [s] or {times = [...], values = [...]}, found an array of 3"},
    {"fractionForInteger", "[output]", "[solver]\nmax_iterations = 1.5\n[output]",
     "bad.toml:40:18: max_iterations in [solver]: expected a whole number from 1 to 1000000, found 1.5"},
    {"wrongPeriodic", "[gravity]", "periodic = [true, 1]\n[gravity]",
     "bad.toml:9:12: periodic in [domain]: expected true, false or an array of 2 of them, found an array of 2"},
    {"tableForList", "[[material]]", "[material]",
     "bad.toml:12:1: material in the case file: expected at least one [[material]], found a table"},
    {"dimensions", "dimensions = 2", "dimensions = 4",
     "bad.toml:2:14: dimensions in the case file: expected 2 or 3, found 4"},
    {"zeroDensity", "density = 1000", "density = 0",
     "bad.toml:14:11: density in [[material]] 'syrup': expected a positive number [kg/m3], found 0"},
    {"negativeDensity", "density = 1000", "density = -1000",
     "bad.toml:14:11: density in [[material]] 'syrup': expected a positive number [kg/m3], found -1000"},
    {"zeroSpacing", "spacing = 1e-3", "spacing = 0.0",
     "bad.toml:3:11: spacing in the case file: expected a positive number [m], found 0"},
    {"negativeSpacing", "spacing = 1e-3", "spacing = -1e-3",
     "bad.toml:3:11: spacing in the case file: expected a positive number [m], found -0.001"},
    {"zeroStep", "step = 1e-3", "step = 0",
     "bad.toml:36:8: step in [time]: expected a positive number [s] or \"auto\", found 0"},
    {"negativeStep", "step = 1e-3", "step = -1e-3",
     "bad.toml:36:8: step in [time]: expected a positive number [s] or \"auto\", found -0.001"},
    {"negativeEnd", "end = 2e-3", "end = -1",
     "bad.toml:37:7: end in [time]: expected a positive number [s], found -1"},
    {"endBeforeFirstStep", "end = 2e-3", "end = 1e-4",
     "bad.toml:37:7: end in [time]: expected at least one step of 0.001 s, found 0.0001"},
    {"negativeViscosity", "dynamic_viscosity = 10", "dynamic_viscosity = -10",
     "bad.toml:15:21: dynamic_viscosity in [[material]] 'syrup': expected a number not less than 0 [Pa s], found "
     "-10"},
    {"nan", "bulk_modulus = 1e6", "bulk_modulus = nan",
     "bad.toml:17:16: bulk_modulus in [[material]] 'syrup': expected a number not less than 0 [Pa] or \"auto\", "
     "found nan"},
    {"infinity", "min = [0, 0]", "min = [0, -inf]",
     "bad.toml:24:7: min in [[body]] 'column' (box): expected an array of 2 finite numbers [m], found -inf"},
    {"zeroRadius", "[output]", "[method]\npressure_radius = 0\n[output]",
     "bad.toml:40:19: pressure_radius in [method]: expected a number between 0 and 20 [spacings], found 0"},
    {"unknownMaterial", "material = \"syrup\"", "material = \"sirup\"",
     "bad.toml:22:12: material in [[body]] 'column' (box): unknown material 'sirup'; did you mean 'syrup'?"},
    {"unknownChoice", "[output]", "[solver]\nkrylov = \"gmres\"\n[output]",
     "bad.toml:40:10: krylov in [solver]: expected 'cg' or 'cr', found 'gmres'"},
    {"unknownPreconditioner", "[output]", "[solver]\npreconditioner = \"ilu\"\n[output]",
     "bad.toml:40:18: preconditioner in [solver]: expected 'projected-multigrid', 'bucket-multigrid', "
     "'block-jacobi', 'jacobi' or 'none', found 'ilu'"},
    {"negativeDegree", "[output]", "[solver.projected]\npressure_degree = -1\n[output]",
     "bad.toml:40:19: pressure_degree in [solver.projected]: expected a whole number from 0 to 1000, found -1"},
    {"noIterations", "[output]", "[solver.projected]\niteration_bound = 0\n[output]",
     "bad.toml:40:19: iteration_bound in [solver.projected]: expected a whole number from 1 to 1000000, found 0"},
    {"negativeDeflation", "[output]", "[solver]\ndeflation = -1\n[output]",
     "bad.toml:40:13: deflation in [solver]: expected a whole number from 0 to 16, found -1"},
    {"manyModes", "[output]", "[solver]\ndeflation = 17\n[output]",
     "bad.toml:40:13: deflation in [solver]: expected a whole number from 0 to 16, found 17"},
    {"unknownNeighbours", "[output]", "[solver]\nneighbours = \"tree\"\n[output]",
     "bad.toml:40:14: neighbours in [solver]: expected 'lists' or 'ranges', found 'tree'"},
    {"unknownCoarseOperators", "[output]", "[solver.multigrid]\ncoarse_operators = \"dense\"\n[output]",
     "bad.toml:40:20: coarse_operators in [solver.multigrid]: expected 'auto', 'direct' or 'spgemm', found "
     "'dense'"},
    {"rangesForTheDefaultPreconditioner", "[output]", "[solver]\nneighbours = \"ranges\"\n[output]",
     "bad.toml:40:14: neighbours in [solver]: expected 'lists' with preconditioner = 'projected-multigrid', found "
     "'ranges': that needs lists"},
    {"rangesForTheMatrix", "[output]",
     "[solver]\npreconditioner = \"none\"\noperator = \"assembled\"\nneighbours = \"ranges\"\n[output]",
     "bad.toml:42:14: neighbours in [solver]: expected 'lists' with operator = 'assembled', found 'ranges': that "
     "needs lists"},
    {"rangesForTheMatrixDiagonal", "[output]",
     "[solver]\npreconditioner = \"bucket-multigrid\"\nneighbours = \"ranges\"\n"
     "multigrid.particle_diagonal = \"extended-jacobi\"\n[output]",
     "bad.toml:41:14: neighbours in [solver]: expected 'lists' with multigrid.particle_diagonal = "
     "'extended-jacobi', found 'ranges'"},
    {"rangesForMatrixProducts", "[output]",
     "[solver]\npreconditioner = \"bucket-multigrid\"\nneighbours = \"ranges\"\n"
     "multigrid.coarse_operators = \"spgemm\"\n[output]",
     "bad.toml:41:14: neighbours in [solver]: expected 'lists' with multigrid.coarse_operators = 'spgemm', found "
     "'ranges'"},
    {"unknownShape", "shape = \"box\"", "shape = \"cube\"",
     "bad.toml:23:9: shape in [[body]] 'column': expected 'box', 'sphere', 'cylinder', 'cone', 'torus', "
     "'polygon', 'polyline', "
     "'mesh' or 'particles', found 'cube'"},
    {"unknownField", "interval = 1e-3", "interval = 1e-3\nfields = [\"speed\"]",
     "bad.toml:41:10: fields in [output]: expected 'velocity', 'pressure', 'number_density', 'nearest_distance', "
     "'material', 'body', 'id', 'dynamic_viscosity', 'shear_rate', 'temperature' or 'viscosity_factor', found "
     "'speed'"},
    {"minAboveMax", "max = [6e-3, 6e-3]", "max = [6e-3, -6e-3]",
     "bad.toml:25:7: max in [[body]] 'column' (box): expected more than min on every axis, found -0.006 <= 0 "
     "along y"},
    {"emptyDomain", "max = [12e-3, 12e-3]", "max = [-4e-3, 12e-3]",
     "bad.toml:7:7: max in [domain]: expected more than min on every axis, found -0.004 <= -0.004 along x"},
    {"shortPeriodicAxis", "max = [12e-3, 12e-3]", "max = [6e-3, 12e-3]\nperiodic = true",
     "bad.toml:8:12: periodic in [domain]: the domain is 10 mm long along x; a periodic axis must hold 3 search "
     "cells of edge max(h_v, h_n, 2 h_p) = 5 mm: expected at least 15 mm"},
    {"unknownMethod", "[output]", "[method]\nname = \"sph\"\nalpha = 2\n[output]",
     "bad.toml:40:8: name in [method]: expected 'mph-i' or 'isph', found 'sph'"},
    {"numberForMethod", "[output]", "[method]\nname = 1\n[output]",
     "bad.toml:40:8: name in [method]: expected a string, found 1"},
    {"keyOfIsph", "[output]", "[method]\nviscosity = \"explicit\"\n[output]",
     "bad.toml:40:1: unknown key 'viscosity' in [method]: it belongs to the method 'isph'; expected 'name', "
     "'scheme', 'pressure_radius', 'density_radius', 'viscosity_radius', 'viscosity_correction', 'tension_limit' "
     "or 'background_pressure'"},
    {"largeBackground", "[output]", "[method]\nbackground_pressure = 2e5\n[output]",
     "bad.toml:40:23: background_pressure in [method]: expected at most 0.1 times the bulk_modulus of 'syrup', "
     "1e+06 "
     "Pa, found 200000"},
    {"keyOfMph", bulk, "[method]\nname = \"isph\"\npressure_radius = 2\n",
     "bad.toml:18:1: unknown key 'pressure_radius' in [method] (isph): it belongs to the method 'mph-i'; expected "
     "'name', 'scheme', 'kernel', 'smoothing_ratio', 'alpha', 'walls', 'viscosity', 'smagorinsky', 'shifting' "
     "or 'negative_pressure'"},
    {"largeSmagorinsky", bulk, "[method]\nname = \"isph\"\nsmagorinsky = 12\n",
     "bad.toml:18:15: smagorinsky in [method] (isph): expected a number from 0 to 0.3, found 12"},
    {"misspeltKeyOfIsph", bulk, "[method]\nname = \"isph\"\nsmoothing = 1.2\n",
     "bad.toml:18:1: unknown key 'smoothing' in [method] (isph); did you mean 'smoothing_ratio'?"},
    {"bulkViscosityOfIsph", "bulk_modulus = 1e6\n", "[method]\nname = \"isph\"\n",
     "bad.toml:16:1: unknown key 'bulk_viscosity' in [[material]] 'syrup': it belongs to the method 'mph-i'; "
     "expected "
     "'name', 'density' or 'dynamic_viscosity'"},
    {"bulkModulusOfIsph", "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n",
     "bulk_modulus = 1e6\n[method]\nname = \"isph\"\n",
     "bad.toml:16:1: unknown key 'bulk_modulus' in [[material]]"},
    {"bulkModulusOfAWord", "bulk_modulus = 1e6", "bulk_modulus = \"stiff\"",
     "bad.toml:17:16: bulk_modulus in [[material]] 'syrup': expected a number not less than 0 [Pa] or \"auto\", "
     "found the string \"stiff\""},
    {"smallSmoothingRatio", bulk, "[method]\nname = \"isph\"\nsmoothing_ratio = 0.89\n",
     "bad.toml:18:19: smoothing_ratio in [method] (isph): expected a number from 0.9 to 2 [spacings], found 0.89: "
     "with less the sums have too few neighbours"},
    {"largeSmoothingRatio", bulk, "[method]\nname = \"isph\"\nsmoothing_ratio = 2.01\n",
     "bad.toml:18:19: smoothing_ratio in [method] (isph): expected a number from 0.9 to 2 [spacings], found 2.01"},
    {"largeAlpha", bulk, "[method]\nname = \"isph\"\nalpha = 1.5\n",
     "bad.toml:18:9: alpha in [method] (isph): expected a number from 0 to 1, found 1.5"},
    {"negativeAlpha", bulk, "[method]\nname = \"isph\"\nalpha = -0.1\n",
     "bad.toml:18:9: alpha in [method] (isph): expected a number from 0 to 1, found -0.1"},
    {"negativeShifting", bulk, "[method]\nname = \"isph\"\nshifting = -1\n",
     "bad.toml:18:12: shifting in [method] (isph): expected a number not less than 0, found -1"},
    {"unknownKernel", bulk, "[method]\nname = \"isph\"\nkernel = \"gauss\"\n",
     "bad.toml:18:10: kernel in [method] (isph): expected 'cubic-spline' or 'wendland-c2', found 'gauss'"},
    {"unknownWalls", bulk, "[method]\nname = \"isph\"\nwalls = \"slip\"\n",
     "bad.toml:18:9: walls in [method] (isph): expected 'no-slip' or 'free-slip', found 'slip'"},
    {"unknownViscousStep", bulk, "[method]\nname = \"isph\"\nviscosity = 1\n",
     "bad.toml:18:13: viscosity in [method] (isph): expected a string, found 1"},
    {"numberForFlag", bulk, "[method]\nname = \"isph\"\nnegative_pressure = 1\n",
     "bad.toml:18:21: negative_pressure in [method] (isph): expected true or false, found 1"},
    {"preconditionerOfMph", bulk, "[method]\nname = \"isph\"\n[solver]\npreconditioner = \"bucket-multigrid\"\n",
     "bad.toml:19:18: preconditioner in [solver] (isph): expected 'hat-multigrid', 'cell-multigrid', 'jacobi' or "
     "'none', found 'bucket-multigrid'"},
    {"preconditionerOfIsph", "[output]", "[solver]\npreconditioner = \"hat-multigrid\"\n[output]",
     "bad.toml:40:18: preconditioner in [solver]: expected 'projected-multigrid', 'bucket-multigrid', "
     "'block-jacobi', 'jacobi' or 'none', found 'hat-multigrid'"},
    {"extrapolationForIsph", bulk, "[method]\nname = \"isph\"\n[solver]\nfirst_guess = \"linear\"\n",
     "bad.toml:19:15: first_guess in [solver] (isph): expected 'last', found 'linear'"},
    {"operatorForIsph", bulk, "[method]\nname = \"isph\"\n[solver]\noperator = \"assembled\"\n",
     "bad.toml:19:1: unknown key 'operator' in [solver] (isph): it belongs to the method 'mph-i'; expected "
     "'krylov', "
     "'preconditioner', 'tolerance', 'max_iterations', 'precision', 'first_guess', 'divided_nodes', 'cells' or "
     "'hats'"},
    {"neighboursForIsph", bulk, "[method]\nname = \"isph\"\n[solver]\nneighbours = \"lists\"\n",
     "bad.toml:19:1: unknown key 'neighbours' in [solver] (isph): it belongs to the method 'mph-i'"},
    {"projectedForIsph", bulk, "[method]\nname = \"isph\"\n[solver.projected]\ngrid_degree = 2\n",
     "bad.toml:18:9: unknown key 'projected' in [solver] (isph): it belongs to the method 'mph-i'"},
    {"multigridForIsph", bulk, "[method]\nname = \"isph\"\n[solver.multigrid]\nfinest_sweeps = 2\n",
     "bad.toml:18:9: unknown key 'multigrid' in [solver] (isph): it belongs to the method 'mph-i'"},
    {"cellsForMph", "[output]", "[solver.cells]\nlevels = 2\n[output]",
     "bad.toml:39:9: unknown key 'cells' in [solver]: it belongs to the method 'isph'; expected 'krylov'"},
    {"noSweeps", bulk, "[method]\nname = \"isph\"\n[solver.cells]\nsweeps = 0\n",
     "bad.toml:19:10: sweeps in [solver.cells]: expected a whole number from 1 to 1000, found 0"},
    {"negativeLevels", bulk, "[method]\nname = \"isph\"\n[solver.cells]\nlevels = -1\n",
     "bad.toml:19:10: levels in [solver.cells]: expected a whole number from 0 to 100, found -1"},
    {"negativeHatDegree", bulk, "[method]\nname = \"isph\"\n[solver.hats]\ngrid_degree = -1\n",
     "bad.toml:19:15: grid_degree in [solver.hats]: expected a whole number from 0 to 1000, found -1"},
    {"noHatIterations", bulk, "[method]\nname = \"isph\"\n[solver.hats]\niteration_bound = 0\n",
     "bad.toml:19:19: iteration_bound in [solver.hats]: expected a whole number from 1 to 1000000, found 0"},
    {"negativeCourantNumber", "end = 2e-3", "end = 2e-3\ncourant = -0.1",
     "bad.toml:38:11: courant in [time]: expected a number not less than 0, found -0.1"},
    {"oscillatingFluid", "max = [6e-3, 6e-3]",
     "max = [6e-3, 6e-3]\noscillation = { amplitude = [1e-3, 0], period = 1 }",
     "bad.toml:26:1: unknown key 'oscillation' in [[body]] 'column' (box); expected 'name', 'type', "},
    {"velocityOfAnUnknownName", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = [0, \"x*speed\"]",
     "bad.toml:26:12: velocity in [[body]] 'column' (box): expected an expression in x, y [m] and the constant "
     "pi, "
     "found \"x*speed\": Unexpected token \"speed\" found at position 2."},
    {"velocityWithoutText", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = [0, \"\"]",
     "bad.toml:26:12: velocity in [[body]] 'column' (box): expected an expression in x, y [m] and the constant "
     "pi, "
     "found \"\": Expression is empty."},
    {"velocityOfWrongLength", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = \"x\"",
     "bad.toml:26:12: velocity in [[body]] 'column' (box): expected an array of 2 finite numbers or expressions "
     "[m/s], found the string \"x\""},
    {"velocityOfAFlag", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = [0, true]",
     "bad.toml:26:12: velocity in [[body]] 'column' (box): expected an array of 2 finite numbers or expressions "
     "[m/s], found true"},
    {"velocityNotFinite", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = [0, \"log(y - 1e-3)\"]",
     "bad.toml:26:12: velocity in [[body]] 'column' (box): \"log(y - 1e-3)\" is not a number for the particle at "
     "(0.5, 0.5) mm; expected a finite number"},
    {"expressionForAWallsVelocity", "max = [12e-3, 0]", "max = [12e-3, 0]\nvelocity = [\"y\", 0]",
     "bad.toml:34:12: velocity in [[body]] 'floor' (box): expected an array of 2 finite numbers [m/s], found the "
     "string \"y\""},
    {"conditionThatAssigns", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"x = 0\"",
     "bad.toml:26:9: where in [[body]] 'column' (box): expected an expression in x, y [m] and the constant pi, "
     "found \"x = 0\": a single = (== compares)"},
    {"conditionOfTwoDimensions", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"z < 1\"",
     "bad.toml:26:9: where in [[body]] 'column' (box): expected an expression in x, y [m] and the constant pi, "
     "found \"z < 1\": Unexpected token \"z\" found"},
    {"conditionWithoutEnd", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"x <\"",
     "bad.toml:26:9: where in [[body]] 'column' (box): expected an expression in x, y [m] and the constant pi, "
     "found \"x <\": Unexpected end of expression"},
    {"conditionIsAFlag", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = true",
     "bad.toml:26:9: where in [[body]] 'column' (box): expected an expression, found true"},
    {"conditionThatLeavesNoFluid", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nwhere = \"y > 1\"",
     "the case has no fluid: no body of type \"fluid\" holds a particle"},
    {"oscillationWithoutPeriod", "max = [12e-3, 0]", "max = [12e-3, 0]\noscillation = { amplitude = [1e-3, 0] }",
     "bad.toml:34:15: period in the oscillation of [[body]] 'floor': missing; expected a positive number [s]"},
    {"dimensionsWithAPoint", "dimensions = 2", "dimensions = 2.0",
     "bad.toml:2:14: dimensions in the case file: expected 2 or 3, found 2.0; write it without a point"},
    {"aNameWithControlCharacters", "name = \"floor\"", "name = \"fl\\u001b[31moor\"",
     "bad.toml:28:8: name in [[body]] 'fl?[31moor' (box): expected no control characters, found one with the code "
     "27"},
    {"oscillationWithoutAmplitude", "max = [12e-3, 0]", "max = [12e-3, 0]\noscillation = { period = 1 }",
     "bad.toml:34:15: amplitude in the oscillation of [[body]] 'floor': missing; expected an array of 2 finite "
     "numbers [m]"},
    {"oscillationIsATable", "max = [12e-3, 0]", "max = [12e-3, 0]\noscillation = 1",
     "bad.toml:34:15: oscillation in [[body]] 'floor' (box): expected a table, found 1"},
    {"unknownKeyOfOscillation", "max = [12e-3, 0]",
     "max = [12e-3, 0]\noscillation = { amplitude = [1e-3, 0], period = 1, frequency = 1 }",
     "bad.toml:34:52: unknown key 'frequency' in the oscillation of [[body]] 'floor'; expected 'amplitude', "
     "'period' "
     "or 'phase'"},
    {"rotatingFluid", "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nrotation = { center = [0, 0], speed = 1 }",
     "bad.toml:26:1: unknown key 'rotation' in [[body]] 'column' (box); expected 'name', 'type', "},
    {"rotationWithoutCenter", "max = [12e-3, 0]", "max = [12e-3, 0]\nrotation = { speed = 1 }",
     "bad.toml:34:12: center in the rotation of [[body]] 'floor': missing; expected an array of 2 finite numbers "
     "[m]"},
    {"rotationWithoutSpeed", "max = [12e-3, 0]", "max = [12e-3, 0]\nrotation = { center = [0, 0] }",
     "bad.toml:34:12: speed in the rotation of [[body]] 'floor': missing; expected a finite number [rad/s]"},
    {"rotationIsANumber", "max = [12e-3, 0]", "max = [12e-3, 0]\nrotation = 1",
     "bad.toml:34:12: rotation in [[body]] 'floor' (box): expected a table, found 1"},
    {"axisInThePlane", "max = [12e-3, 0]",
     "max = [12e-3, 0]\nrotation = { center = [0, 0], speed = 1, axis = [0, 0, 1] }",
     "bad.toml:34:42: unknown key 'axis' in the rotation of [[body]] 'floor'; expected 'center', 'speed' or "
     "'angle'"},
    {"rotationAcrossAPeriod", "max = [12e-3, 12e-3]",
     "max = [16e-3, 12e-3]\nperiodic = [true, false]\n[[body]]\nname = \"blade\"\ntype = \"wall\"\n"
     "material = \"syrup\"\nshape = \"box\"\nmin = [7e-3, 1e-3]\nmax = [8e-3, 12e-3]\n"
     "rotation = { center = [7.5e-3, 0.5e-3], speed = 1 }",
     "rotating wall 'blade' reaches 11 mm along the periodic x axis from its centre; expected less than half the "
     "domain, 10 mm"},
    {"widthWithoutAxis", "[output]", "[width]\nfactor = 4\n[output]",
     "bad.toml:39:1: axis in [width]: missing; expected a string"},
    {"widthAlongNoAxis", "[output]", "[width]\naxis = \"z\"\nfrom = 0\nto = 1\n[output]",
     "bad.toml:40:8: axis in [width]: expected 'x' or 'y', found 'z'"},
    {"widthOfNothing", "[output]", "[width]\naxis = \"x\"\nfrom = 1\nto = 1\n[output]",
     "bad.toml:42:6: to in [width]: expected more than from = 1, found 1"},
    {"widthTimesNothing", "[output]", "[width]\naxis = \"x\"\nfrom = 0\nto = 1\nfactor = 0\n[output]",
     "bad.toml:43:10: factor in [width]: expected a positive number, found 0"},
    {"noName", "name = \"column\"\n", "", "bad.toml:19:1: every [[body]] needs a name: name = \"...\""},
    {"nameTwice", "name = \"floor\"", "name = \"column\"", "bad.toml:27:1: two [[body]] are named 'column'"},
    {"noFluid", "type = \"fluid\"", "type = \"wall\"",
     "bad.toml:19:1: body in the case file: no fluid: expected at least one [[body]] with type = \"fluid\" or "
     "\"inflow\""},
    {"negativeProfile", "[time]",
     "[[body]]\nname = \"jet\"\ntype = \"inflow\"\nmaterial = \"syrup\"\nspeed = 1\nprofile = \"1 - (x/1e-3)^2\"\n"
     "nozzle = {shape = \"rectangle\", center = [0, 8e-3], direction = [0, 1], width = 4e-3}\n[time]",
     "bad.toml:40:11: profile in [[body]] 'jet' (inflow): \"1 - (x/1e-3)^2\" is -1.25 for the column of particles "
     "at "
     "(-1.5, 8) mm; expected a finite number not less than 0"},
    {"overlap", "max = [12e-3, 0]", "max = [12e-3, 1e-3]",
     "fluid body 'column' and wall body 'floor' overlap: 6 wall particles closer than half a spacing to the "
     "fluid, "
     "the first at (0.5, 0.5) mm"},
    {"outsideDomain", "max = [6e-3, 6e-3]", "max = [6e-3, 13e-3]",
     "body 'column' reaches out of the domain: a particle at (0.5, 12.5) mm, the domain is (-4, -4) mm to (12, "
     "12) "
     "mm"},
    {"domainOfTooManyCells", "min = [-4e-3, -4e-3]\nmax = [12e-3, 12e-3]", "min = [-2e6, -2e6]\nmax = [2e6, 2e6]",
     "bad.toml:7:7: max in [domain]: the domain has 8e+08 search cells of edge 5 mm along x, expected at most "
     "5.37e+08: take a smaller domain or a larger spacing"},
    {"domainTooFarAway", "max = [12e-3, 12e-3]", "max = [1e13, 12e-3]",
     "bad.toml:7:7: max in [domain]: found 10000000000000 m along x, expected at most 4.5e+06 m from 0: farther "
     "away "
     "positions "
     "are rounded by more than a millionth of the spacing of 1 mm"},
    {"domainWithoutAnEnd", "min = [-4e-3, -4e-3]", "min = [-1.7e308, -4e-3]",
     "bad.toml:6:7: min in [domain]: found -1.7e+308 m along x"},
    {"smallCourantNumber", "end = 2e-3", "end = 2e-3\ncourant = 1e-20",
     "bad.toml:38:11: courant in [time]: expected 0 or a number from 1e-06 to 100, found 1e-20"},
    {"largeCourantNumber", "end = 2e-3", "end = 2e-3\ncourant = 1e9",
     "bad.toml:38:11: courant in [time]: expected 0 or a number from 1e-06 to 100, found 1000000000"},
    {"noSuchStep", "step = 1e-3", "step = \"automatic\"",
     "bad.toml:36:8: step in [time]: expected a positive number [s] or \"auto\", found the string \"automatic\""},
    {"stepFlag", "step = 1e-3", "step = true",
     "bad.toml:36:8: step in [time]: expected a positive number [s] or \"auto\", found true"},
    {"noStep", "step = 1e-3\n", "",
     "bad.toml:35:1: step in [time]: missing; expected a positive number [s] or \"auto\""},
    {"toleranceOfEqualSteps", "step = 1e-3", "step = 1e-3\ntolerance = 0.1",
     "bad.toml:37:1: unknown key 'tolerance' in [time]: it belongs to step = \"auto\"; expected 'step', 'end' or "
     "'courant'"},
    {"negativeStepTolerance", "step = 1e-3", "step = \"auto\"\ntolerance = -0.1",
     "bad.toml:37:13: tolerance in [time]: expected a number from 1e-06 to 0.5, found -0.1"},
    {"stepToleranceInWords", "step = 1e-3", "step = \"auto\"\ntolerance = \"small\"",
     "bad.toml:37:13: tolerance in [time]: expected a number from 1e-06 to 0.5, found the string \"small\""},
    {"leastStepAboveTheLongest", "step = 1e-3", "step = \"auto\"\nmin_step = 1e-2\nmax_step = 1e-3",
     "bad.toml:37:12: min_step in [time]: expected at most max_step = 0.001 s, found 0.01"},
    {"longestStepOfNothing", "step = 1e-3", "step = \"auto\"\nmax_step = 0",
     "bad.toml:37:12: max_step in [time]: expected a positive number [s], found 0"},
    {"tooManySteps", "end = 2e-3", "end = 1e300",
     "bad.toml:36:8: step in [time]: 1e+303 steps to the end are too many"},
    {"tooManyFrames", "interval = 1e-3", "interval = 1e-300",
     "bad.toml:40:12: interval in [output]: 2e+297 intervals to the end are too many"},
    {"largeRadius", "[output]", "[method]\nviscosity_radius = 1e9\n[output]",
     "bad.toml:40:20: viscosity_radius in [method]: expected a number between 0 and 20 [spacings], found "
     "1000000000"},
    {"largeDegree", "[output]", "[solver.projected]\ngrid_degree = 2000000000\n[output]",
     "bad.toml:40:15: grid_degree in [solver.projected]: expected a whole number from 0 to 1000, found "
     "2000000000"},
    {"manySweeps", "[output]", "[solver.multigrid]\ncoarsest_sweeps = 1000000000\n[output]",
     "bad.toml:40:19: coarsest_sweeps in [solver.multigrid]: expected a whole number from 1 to 1000, found "
     "1000000000"},
    {"tooManyParticles", "spacing = 1e-3", "spacing = 1e-9",
     "body 'column' would have more than 4294966272 particles; take a larger spacing or a lower resolution"},
    {"outflowOverAllFluid", bulk,
     "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n[[outflow]]\nname = \"drain\"\nshape = \"box\"\nmin = [-4e-3, "
     "0]\nmax = [12e-3, "
     "12e-3]\n",
     "outflow 'drain' holds 36 of 36 fluid particles at the start, which leave in the first step; no fluid would "
     "be "
     "left: expected an outflow beside the fluid"},
    {"baseMissing", "title", "base = \"none.toml\"\ntitle", "bad.toml:1:8: base: no such case file: none.toml"},
    {"baseIsItself", "title", "base = \"bad.toml\"\ntitle", "bad.toml:1:8: base: 'bad.toml' inherits from itself"},
};

INSTANTIATE_TEST_SUITE_P(Case, BadInput, testing::ValuesIn(badCases),
                         [](const auto& test) { return test.param.name; });

/// A command line that is rejected on a sound case.
struct BadLine {
  const char* name;
  const char* arguments;
  const char* message;  // part of what is printed
};

void PrintTo(const BadLine& bad, std::ostream* out) { *out << bad.name; }

class BadArguments : public testing::TestWithParam<BadLine> {};

TEST_P(BadArguments, areRejectedWithReason) {
  const BadLine& bad = GetParam();
  Workshop shop;
  shop.put("small.toml", smallCase);
  const Outcome outcome = shop.call(bad.arguments);
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr(bad.message));
  EXPECT_FALSE(std::filesystem::exists(shop / "small-run"));
}

constexpr BadLine badLines[] = {
    {"noCommand", "", "expected a command: run, check, plot, surface, "},
    {"unknownCommand", "rum small.toml", "rum"},
    {"noCase", "run", "CASE is required"},
    {"unknownOption", "run small.toml --fast", "--fast"},
    {"missingFile", "run none.toml", "treacle: error: none.toml: no such case file"},
    {"directoryAsFile", "check .", "treacle: error: .: is a directory"},
    {"unknownBackend", "run small.toml --backend gpu", "--backend: expected auto|cpu|cuda, found 'gpu'"},
    {"unknownPrecision", "run small.toml --precision half", "--precision: expected mixed|double, found 'half'"},
    {"noThreads", "run small.toml --threads 0", "--threads: expected a whole number from 1 to 1024, found '0'"},
    {"manyThreads", "run small.toml --threads 100000",
     "--threads: expected a whole number from 1 to 1024, found '100000'"},
    {"endTimeWithoutEnd", "run small.toml --end-time 1e300", "--end-time: 1e+303 steps to the end are too many"},
    {"setComment", "check small.toml --set '#=1'", "--set #=1: expected one key=value, found 0"},
    {"setTwoKeys", "check small.toml --set \"$(printf 'spacing=1e-3\\ntitle=1')\"",
     "expected one key=value, found 2"},
    {"factorWithoutWidth", "run small.toml --set width.factor=4",
     "--set width.factor=4: axis in [width]: missing; expected a string"},
    {"negativeEndTime", "run small.toml --end-time=-1", "--end-time: expected a positive number, found '-1'"},
    {"endTimeOfACheckBelowStep", "check small.toml --end-time 1e-4",
     "--end-time: expected at least one step of 0.001 s"},
    {"endTimeBelowStep", "run small.toml --end-time 1e-4", "--end-time: expected at least one step of 0.001 s"},
    {"setWithoutValue", "run small.toml --set spacing", "--set spacing: expected key=value"},
    {"setUnknownKeyNearNone", "run small.toml --set body.column.name=syrup --set nope=1",
     "--set nope=1: unknown key 'nope'; expected 'title', 'dimensions', 'spacing', 'resolution', 'domain', "
     "'gravity', 'frame', 'material', 'body', 'outflow', 'opening', 'time', 'method', 'rheology', 'heat', 'gas', "
     "'solver', "
     "'output', 'probe', 'watch', 'base', 'width', 'syrup' or 'floor'"},
    {"setUnknownKey", "run small.toml --set spaceing=1",
     "--set spaceing=1: unknown key 'spaceing'; did you mean "
     "'spacing'?"},
    {"setUnknownKeyOfMaterial", "run small.toml --set syrup.densty=1",
     "--set syrup.densty=1: unknown key 'densty' in [[material]] 'syrup'; did you mean 'density'?"},
    {"setUnknownBody", "run small.toml --set body.colum.shape=box",
     "--set body.colum.shape=box: there is no [[body]] 'colum'; did you mean 'column'?"},
    {"setWrongType", "run small.toml --set time.end=soon",
     "--set time.end=soon: end in [time]: expected a positive number [s], found the string \"soon\""},
    {"setImpossibleValue", "run small.toml --set material.syrup.density=-1",
     "--set material.syrup.density=-1: density in [[material]] 'syrup': expected a positive number [kg/m3], found "
     "-1"},
    {"setBase", "run small.toml --set base=x.toml", "--set base=x.toml: base can only be given in a case file"},
    {"setWholeMaterial", "run small.toml --set syrup=1", "--set syrup=1: expected material.syrup.key=value"},
    {"plotOfNoRun", "plot .", "not the directory of a run"},
};

INSTANTIATE_TEST_SUITE_P(Line, BadArguments, testing::ValuesIn(badLines),
                         [](const auto& test) { return test.param.name; });

TEST(BadBase, cycleOverSeveralFiles) {
  Workshop shop;
  shop.put("a.toml", "base = \"sub/b.toml\"\n");
  shop.put("sub/b.toml", "base = \"../a.toml\"\n");
  const Outcome outcome = shop.call("check a.toml");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err, "treacle: error: sub/b.toml:1:8: base: '../a.toml' inherits from itself\n");
}

TEST(BadBase, errorsNameTheFileThatHoldsTheValue) {
  Workshop shop;
  shop.put("base.toml", replaced(smallCase, "density = 1000", "density = -1"));
  shop.put("derived.toml", "base = \"base.toml\"\n[time]\nend = 1\n");
  EXPECT_THAT(shop.call("check derived.toml").err, StartsWith("treacle: error: base.toml:14:11: density"));
  shop.put("derived.toml", "base = \"base.toml\"\n[[material]]\nname = \"syrup\"\ndensity = -2\n");
  EXPECT_THAT(shop.call("check derived.toml").err, StartsWith("treacle: error: derived.toml:4:11: density"));
}

TEST(BadOutput, fileInTheWay) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  shop.put("taken", "something");
  const Outcome outcome = shop.call("run small.toml -o taken");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("taken"));
  EXPECT_EQ(shop.content("taken"), "something");
  EXPECT_EQ(shop.call("run small.toml -o taken/below").exitCode, 2);
}

TEST(BadOutput, existingRunWithoutForce) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  ASSERT_EQ(shop.call("run small.toml --threads 1").exitCode, 0);
  const std::string history = shop.content("small-run/history.csv");
  const Outcome outcome = shop.call("run small.toml --threads 1");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--force"));
  EXPECT_EQ(shop.content("small-run/history.csv"), history);
  EXPECT_EQ(shop.call("run small.toml --threads 1 --force").exitCode, 0);
}

TEST(FullDisk, endsTheRunWithDiagnosisAndLeavesNoPartOfAFile) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  // 4 KiB a file: enough for the texts, not for the walls of a frame.
  const Outcome outcome =
      shop.call("run small.toml --threads 1 --set output.compression=none", "trap '' XFSZ; ulimit -f 8;");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, HasSubstr("small-run/frames/"));
  EXPECT_THAT(outcome.err, HasSubstr("File too large"));
  for (const auto& entry : std::filesystem::directory_iterator(shop / "small-run/frames")) {
    EXPECT_EQ(entry.path().extension(), ".vtp");
    EXPECT_NO_THROW(readVtp(entry.path()));
  }
  EXPECT_THAT(shop.content("small-run/summary.json"), HasSubstr("\"status\": \"failed\""));
  EXPECT_THAT(shop.content("small-run/case.toml"), EndsWith("\ndensity = 0.25\n"));
}

TEST(FullDisk, foundByTheOutputThreadEndsTheRunAndKeepsTheFrames) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  // 8 KiB a file: enough for the frames, not for a checkpoint. Without the first one the run would take hours.
  const Outcome outcome = shop.call(
      "run small.toml --threads 1 --end-time 30 --set output.checkpoint_interval=2e-3 "
      "--set 'gravity.acceleration=[0, -1e-3]'",
      "trap '' XFSZ; ulimit -f 16;");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, ContainsRegex("treacle: error: after step [0-9]+ .*: cannot write "
                                         "small-run/checkpoint.h5: File too large\n"));
  EXPECT_FALSE(std::filesystem::exists(shop / "small-run/checkpoint.h5"));
  // The last state is on disk, with all frames before it.
  const RunDirectory run = RunDirectory::open(shop / "small-run");
  const auto rows = readHistory(run.history());
  ASSERT_EQ(run.frameCount(), rows.size() + 1);
  for (std::size_t k = 1; k < run.frameCount(); ++k) {
    EXPECT_EQ(run.frameTime(k), rows[k - 1].time);
    EXPECT_EQ(readVtp(run.fluidFrame(k)).time, rows[k - 1].time);
  }
  EXPECT_THAT(shop.content("small-run/summary.json"), HasSubstr("checkpoint.h5: File too large"));
}

/// Warnings: the case is run nevertheless.
struct Warning {
  const char* name;
  const char* from;
  const char* to;
  const char* text;
};

void PrintTo(const Warning& warning, std::ostream* out) { *out << warning.name; }

class Warnings : public testing::TestWithParam<Warning> {};

TEST_P(Warnings, areShownByCheckAndRunAndLogged) {
  const Warning& warning = GetParam();
  Workshop shop;
  shop.put("case.toml", replaced(smallCase, warning.from, warning.to));
  const std::string line = std::string("treacle: warning: ") + warning.text + "\n";
  const Outcome check = shop.call("check case.toml");
  EXPECT_EQ(check.exitCode, 0);
  EXPECT_THAT(check.err, HasSubstr(line));
  const Outcome run = shop.call("run case.toml --threads 1");
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr(line));
  EXPECT_THAT(shop.content("case-run/run.log"), HasSubstr(std::string("warning: ") + warning.text));
  EXPECT_THAT(shop.call("run case.toml --threads 1 --force --quiet").err, IsEmpty());
}

constexpr Warning warnings[] = {
    {"thinWall", "min = [-4e-3, -4e-3]\nmax = [12e-3, 0]", "min = [-4e-3, -2e-3]\nmax = [12e-3, 0]",
     "wall 'floor' is 2 mm thick along y, thinner than the viscosity radius h_v = 3.5 mm (3.5 spacings): fluid "
     "next "
     "to it misses neighbours"},
    {"fluidInAnOutflow", "[output]",
     "[[outflow]]\nname = \"drain\"\nshape = \"box\"\nmin = [4e-3, 0]\nmax = [12e-3, 12e-3]\n[output]",
     "outflow 'drain' holds 12 of 36 fluid particles at the start, which leave in the first step"},
    {"shortRadius", "[output]", "[method]\nscheme = \"accurate\"\npressure_radius = 2\n[output]",
     "method.pressure_radius = 2 spacings is short for the scheme 'accurate', expected at least 2.5: sums over "
     "so "
     "few neighbours depend on where these stand"},
    {"unstableCompression", "bulk_modulus = 1e6", "bulk_modulus = 2e7",
     "material 'syrup': dt kappa / lambda = 2 is greater than 0.5, the step may be unstable; take bulk_modulus <= "
     "0.5 bulk_viscosity / step, or a step of at most 0.00025 s"},
    {"spacingThatDoesNotDivide", "max = [6e-3, 6e-3]", "max = [6e-3, 6.4e-3]",
     "body 'column': 6.4 mm along y is 6.4 spacings; filled with 6 particles from its min corner (6 mm)"},
    {"endBetweenSteps", "end = 2e-3", "end = 2.3e-3",
     "time.end = 0.0023 s is not a whole number of steps of 0.001 s; the run makes 2 steps and ends at 0.002 s"},
    {"outputBetweenSteps", "interval = 1e-3", "interval = 1.2e-3",
     "output.interval = 0.0012 s is not a whole number of steps of 0.001 s; frames are written at the nearest "
     "step"},
};

INSTANTIATE_TEST_SUITE_P(Case, Warnings, testing::ValuesIn(warnings),
                         [](const auto& test) { return test.param.name; });

TEST(BadText, keysInKeysInKeysAreRefused) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  std::string plain = "a", quoted = "\".=\"", arrays, tables;
  for (int k = 0; k < 40000; ++k) plain += ".a", quoted += " . 'b=\"'", arrays += '[', tables += "{a=";
  shop.put("key.toml", smallCase + plain + " = 1\n");
  shop.put("quoted.toml", smallCase + quoted + " = 1\n");
  shop.put("table.toml", smallCase + '[' + plain + "]\n");
  shop.put("arrays.toml", smallCase + "a = " + arrays);
  shop.put("tables.toml", smallCase + "a = " + tables);
  for (const char* name : {"key", "quoted", "table", "arrays", "tables"}) {
    const Outcome outcome = shop.call(std::string("check ") + name + ".toml");
    EXPECT_EQ(outcome.exitCode, 2) << name;
    EXPECT_THAT(outcome.err, StartsWith(std::string("treacle: error: ") + name + ".toml:41")) << name;
    EXPECT_LT(outcome.err.size(), 300u);
  }
  // A text that ends in the middle of a line, and quotes that nothing ends: looked at once and not again and
  // again.
  shop.put("text.toml", smallCase + "a = {b = \"\"\"c\"d\"\"\", " + plain + " = 1}\n");
  EXPECT_THAT(shop.call("check text.toml").err,
              StartsWith("treacle: error: text.toml:41: not valid TOML for a case"));
  std::string unended = "title = \"";
  while (unended.size() < 3000000) unended += "\\\"";
  shop.put("unended.toml", unended);
  EXPECT_EQ(shop.call("check unended.toml", "timeout 20").exitCode, 2);
  const Outcome outcome = shop.call("check small.toml --set " + plain + "=1");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("found a key of hundreds of parts"));
}

TEST(BadText, pipesAreReadAndNotWaitedFor) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  Outcome outcome = shop.call("check pipe", "mkfifo pipe; timeout 20");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("pipe:1:1: dimensions in the case file: missing"));
  outcome = shop.call("check /dev/stdin", "cat small.toml |");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  outcome = shop.call("check /dev/zero", "timeout 20");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/dev/zero: too large for a case file"));
}

TEST(BadText, aBodyMuchTooLargeIsFoundBeforeItIsFilled) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs more address space than the limit of this test";
#endif
  Workshop shop;
  shop.put("drop.toml", R"(dimensions = 3
spacing = 5e-3
domain = {min = [-0.1, -0.1, -0.1], max = [0.1, 0.1, 0.1]}
material = [{name = "syrup", density = 1, dynamic_viscosity = 1, bulk_viscosity = 1, bulk_modulus = 0}]
body = [{name = "drop", type = "fluid", material = "syrup", shape = "sphere", center = [0, 0, 0], radius = 1.5}]
time = {step = 1e-3, end = 1}
)");
  // 113 million particles.
  const Outcome outcome = shop.call("check drop.toml", "ulimit -v 1000000; OMP_NUM_THREADS=1 timeout 60");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("body 'drop' reaches out of the domain: a particle at "));
}

}  // namespace
}  // namespace treacle::test

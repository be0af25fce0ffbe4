#include "errors.hpp"

#include "memory.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_error.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <exception>

namespace treacle {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

void raise(const char* name, const nb::object& error) {
  PyErr_SetObject(nb::module_::import_("treacle.errors").attr(name).ptr(), error.ptr());
}

nb::object errorClass(const char* name) { return nb::module_::import_("treacle.errors").attr(name); }

nb::object orNone(const std::string& text) { return text.empty() ? nb::none() : nb::object(nb::cast(text)); }
nb::object orNone(std::uint32_t number) { return number == 0 ? nb::none() : nb::object(nb::cast(number)); }

void raiseInput(const std::exception& e, const CasePlace& place, const std::string& key) {
  const nb::object error =
      errorClass("InputError")(forPython(e.what()), "file"_a = orNone(place.file), "line"_a = orNone(place.line),
                               "column"_a = orNone(place.column), "key"_a = orNone(key));
  raise("InputError", error);
}

void raiseRun(const std::string& diagnosis) { raise("RunError", errorClass("RunError")(forPython(diagnosis))); }

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const CaseFileError& e) {
    raiseInput(e, e.place(), e.key());
  } catch (const CaseError& e) {
    raiseInput(e, {}, e.path().empty() ? "" : e.path().back());
  } catch (const InputError& e) {
    raiseInput(e, {}, {});
  } catch (const RunError& e) {
    raiseRun(e.what());
  } catch (const DeviceMemoryExhausted& e) {
    raiseRun(exhaustedText(e.numbers()));
  } catch (const DeviceFailure& e) {
    raiseRun(e.what());
  }
}

}  // namespace

std::string forPython(std::string text) {
  const auto replace = [&](std::string_view option, std::string_view word) {
    for (std::size_t k = text.find(option); k != text.npos; k = text.find(option, k + word.size()))
      text.replace(k, option.size(), word);
  };
  replace("--backend cpu", "backend=\"cpu\"");
  replace("--backend cuda", "backend=\"cuda\"");
  replace("--resume ", "checkpoint ");
  replace("--force", "force=True");
  replace("--threads", "threads");
  replace("--set ", "overrides ");
  return text;
}

void registerErrors() { nb::register_exception_translator(translate); }

}  // namespace treacle

"""Tests one_definition.py with small trees. Usage: python3 one_definition_test.py"""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import one_definition


def result(files: dict[str, str]) -> tuple[int, str]:
    """Exit code and output for a tree of these files."""
    with tempfile.TemporaryDirectory() as directory, contextlib.redirect_stdout(io.StringIO()) as output:
        for name, text in files.items():
            (Path(directory) / name).write_text(text)
        return one_definition.main([directory]), output.getvalue()


class OneDefinition(unittest.TestCase):
    def test_names_both_files_of_a_type_that_is_defined_twice(self) -> None:
        code, output = result(
            {
                "a.hpp": "namespace treacle {\n/// A row.\nstruct Row { int i; };\n}",
                "b.cuh": "namespace treacle {\ntemplate <int D>\nclass Row final : public Base<D> {\n};\n}",
            }
        )
        self.assertEqual(code, 1)
        self.assertRegex(output, r"treacle::Row is defined in .*a\.hpp, .*b\.cuh")

    def test_lets_types_be_that_are_declared_specialised_nested_or_unnamed(self) -> None:
        code, output = result(
            {
                "a.hpp": "namespace treacle {\nstruct Row { struct Held { int i; }; };\nenum class Kind { A };\n}",
                "b.hpp": "namespace treacle {\nstruct Row;\ntemplate <>\nstruct Row<2> { };\nstruct Other { enum class Kind { B }; };\n}",
                "c.cpp": "namespace treacle {\nnamespace {\nstruct Row { };\n}\nvoid f() { struct Row { }; }\n// struct Row { };\n}",
                "d.cpp": "namespace elsewhere {\nstruct Row { };\n}",
            }
        )
        self.assertEqual((code, output), (0, ""))

    def test_fails_where_it_finds_nothing(self) -> None:
        self.assertEqual(result({"a.txt": "struct Row { };"})[0], 1)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Tests of the small parsers behind style.sizes and style.words: they must find what they are there to find."""
import unittest

import sizes_test
import sources

CPP = '''#define BRACE {
namespace a {  // { no brace
constexpr int table[] = {1, 2};
struct S {
    int x{0};
    S(int a, T b = {}) : x{a}, y_(b) {
        f("}");
    }
    bool operator==(const S&) const = default;
};
TEST(Group, Name) {
    const auto lambda = [&](int i) {
        return i;
    };
}
template <typename T>
auto longOne(T t)
    -> int {
    if (t) { g(1'000'000, '{'); }
    return R"x(}})x";
}
}
'''


class Functions(unittest.TestCase):
    def test_cpp(self):
        found = [(line, lines, name) for line, lines, name in sizes_test.brace_functions(CPP)]
        self.assertEqual(found, [(6, 3, "S"), (11, 5, "TEST"), (16, 6, "longOne")])

    def test_javascript(self):
        text = "const a = { b: 1 };\nclass C {\n  go(x) {\n    return `}${x}`;\n  }\n}\nfunction f() {\n}\n"
        self.assertEqual([name for _, _, name in sizes_test.brace_functions(text)], ["go", "f"])

    def test_python(self):
        self.assertEqual(sizes_test.python_functions("def f():\n    pass\n\n\n\n"), [(1, 2, "f")])

    def test_limits(self):
        self.assertEqual(sizes_test.file_limit("src/a.cpp"), 400)
        self.assertEqual(sizes_test.file_limit("tests/unit/a.cpp"), 600)
        self.assertEqual(sizes_test.file_limit("shaders/lib/a.glsl"), 200)


class Texts(unittest.TestCase):
    def test_comments(self):
        text = 'int a;  // one\nchar* b = "// none";\n/* two\n   three */\n'
        self.assertEqual(sources.comments(text), [(1, "// one"), (3, "/* two"), (4, "   three */")])

    def test_strings(self):
        text = 'f("one", \'"\');  // "none"\ng(R"(two\n"three")");\n'
        self.assertEqual([words for _, words in sources.strings(text)], ['"one"', 'R"(two', '"three")"'])

    def test_lines_stay(self):
        self.assertEqual(sources.without_comments(CPP).count("\n"), CPP.count("\n"))


if __name__ == "__main__":
    unittest.main()

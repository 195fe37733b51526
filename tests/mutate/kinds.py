"""Replacements that make mutants, and code that gets none."""
import re

COMPARISONS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
NEGATED = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "&": "|", "|": "&", "<<": ">>", ">>": "<<"}
COMPOUND = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|=", "<<=": ">>=", ">>=": "<<="}
STEPS = {"++": "--", "--": "++"}

# Calls whose other one has the same arguments and result.
NAMES = {
    "min": "max", "max": "min", "lower_bound": "upper_bound", "upper_bound": "lower_bound", "floor": "ceil", "ceil": "floor",
    "any_of": "all_of", "all_of": "any_of", "none_of": "all_of", "front": "back", "back": "front", "min_element": "max_element",
    "max_element": "min_element", "x": "y", "y": "z", "z": "x", "sin": "cos", "cos": "sin",
    "minCoeff": "maxCoeff", "maxCoeff": "minCoeff", "starts_with": "ends_with", "ends_with": "starts_with", "find_first_of": "find_last_of",
}

# Nobody opens file 0.
DESCRIPTOR = re.compile(r"\b(fd_?|file|socket|descriptor|listener)(_?\.get\(\))?$|\.fd\(\)$|_fd_?$")

# What only makes things quicker, or only tells a log: no statement, argument or constant of these calls is changed.
UNWATCHED = {
    "reserve", "shrink_to_fit", "prefer_large_pages", "madvise", "__builtin_prefetch", "__builtin_expect", "pthread_setname_np",
}
UNWATCHED_PREFIXES = ("logging::", "spdlog::")

# Exchanging their arguments changes nothing, or only words.
SYMMETRIC = {"fail", "min", "max", "hypot", "swap", "dot", "minmax", "gcd", "lcm"}

#!/usr/bin/env python3
"""Checks the levels of the architecture (docs/architecture.md) against every #include of the sources, that types of
all modules have distinct names, and that public headers export what they declare.

usage: tools/check_levels.py [ROOT]

Prints one line for each include that breaks a rule and exits with 1 if there is any.
"""

import re
import sys
from pathlib import Path

# The levels, lowest first. A module may include itself and its modules in MODULES, which are on lower levels.
LEVELS = [
    ["core"],
    ["mesh", "contour", "system", "findings"],
    ["slicing", "polygon", "raster", "container"],
    ["scan", "meshes"],
    ["slices"],
    ["inputs"],
    ["jobs"],
    ["c"],
]

# The modules of the engine. They may include no other module.
ENGINE = ["core", "mesh", "contour", "slicing", "polygon", "scan"]

# The modules that each module may include besides itself.
MODULES = {
    "core": [],
    "mesh": ["core"],
    "contour": ["core"],
    "system": ["core"],
    "findings": ["core"],
    "container": ["core", "findings", "system", "contour"],
    "meshes": ["core", "findings", "system", "container", "mesh", "contour"],
    "slicing": ["core", "mesh", "contour"],  # not container: engines know no formats
    "polygon": ["core", "contour"],  # not mesh: layers of any source
    "raster": ["core", "contour"],  # not container: pixels, not files
    "scan": ["core", "contour", "polygon"],  # not mesh: layers of any source
    "slices": ["core", "findings", "system", "container", "mesh", "contour", "polygon", "raster", "meshes"],  # not slicing: any layers
    "inputs": ["core", "findings", "system", "container", "mesh", "contour", "meshes", "slices"],
    "jobs": ["core", "findings", "system", "container", "mesh", "contour", "slicing", "polygon", "raster", "scan", "meshes", "slices", "inputs"],
    "c": ["core", "findings", "mesh", "contour", "slicing", "polygon", "meshes", "slices", "inputs", "jobs"],  # only what it passes on
}

# Third-party headers of the library. Each may be included by one source (zlib by those that compress and decompress,
# the hash by one for layers, one for files and one for chunks of files). Text formatting is allowed everywhere.
THIRD_PARTY = {
    "expat.h": "src/container/xml.cpp",
    "fast_float": "src/container/parse_number.cpp",
    "libdeflate.h": "src/container/inflate.cpp",
    "xxhash.h": "src/container/file_hash.cpp src/contour/normal_form.cpp",
    "zlib.h": "src/container/deflate.cpp src/container/gzip.cpp",
}
THIRD_PARTY_ANYWHERE = {"fmt"}
# Third-party headers of the programs.
THIRD_PARTY_OF_CONSUMERS = {
    "mpi.h": "app/mpi_processes.cpp",
    "polyclipping/clipper.hpp": "bench/offsets_of_others.cpp bench/scan.cpp",
    "toml++/toml.h": "app/toml_file.cpp",
}

# Private headers that the programs may include: what they need of the operating system apart from the library.
SYSTEM_OF_PROGRAMS = re.compile(r"^src/system/program_[a-z_]+\.hpp$")

# The only other consumers that may include private headers: one measures the kernels alone, one makes a mesh as 3MF file.
BENCHMARKS_OF_PRIVATE = ["bench/cores.cpp", "bench/kernels.cpp"]

STANDARD_OF_C = {"stddef.h", "stdint.h"}
STANDARD = set(
    """algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono
    cinttypes climits clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp
    csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception
    execution filesystem format forward_list fstream functional future initializer_list iomanip ios iosfwd
    iostream istream iterator latch limits list locale map memory memory_resource mutex new numbers numeric
    optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
    source_location span sstream stack stdexcept streambuf string string_view strstream
    syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility
    valarray variant vector version""".split()
)

# Headers of the operating system, which only the sources of one module may include.
SYSTEM = re.compile(r"^((sys|linux|net|netinet|arpa)/.*|(unistd|fcntl|sched|pthread|poll|signal|spawn|dirent|dlfcn|"
                    r"malloc|errno|limits|stdlib|stdint|windows|winioctl|aclapi|shellapi|psapi|io)(\.h)?)$")
SYSTEM_MODULE = "src/system/"

# The folder of a module whose headers all sources of the module, and of modules above, may include.
SHARED_FOLDER = "src/slices/engine"

# Types at namespace level, as headers lay them out.
TYPE = re.compile(r"^(?:template <[^\n]*>\n)?(?:class|struct|union|enum class) (\w+)(?: final)?(?: : [^{;\n]*)? \{", re.MULTILINE)

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:<([^>\n]+)>|"([^"\n]+)")', re.MULTILINE)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


class Architecture:
    def __init__(self, root):
        self.root = Path(root).resolve()
        self.findings = []

    def check(self):
        self.check_table()
        for folder in ["include", "src", "parts", "viewer", "app", "bench", "examples", "python", "tests"]:
            for path in sorted((self.root / folder).rglob("*")):
                if path.suffix in (".hpp", ".cpp", ".h", ".inc"):
                    self.check_file(path)
        self.check_type_names()
        self.check_exports()
        return self.findings

    def check_type_names(self):
        """All modules share one namespace, so types must have distinct names, even if no source sees both."""
        known = {}
        for folder in ["include", "src"]:
            for path in sorted((self.root / folder).rglob("*.hpp")):
                name = path.relative_to(self.root).as_posix()
                for match in TYPE.finditer(path.read_text(encoding="utf-8")):
                    first = known.setdefault(match[1], name)
                    if first != name:
                        self.findings.append(f"{name}: {match[1]} is the name of a type in {first}, too")

    def check_exports(self):
        """A shared library exports the declarations between two macros (lamella/core/api.hpp)."""
        for path in sorted((self.root / "include").rglob("*.hpp")):
            text = path.read_text(encoding="utf-8")
            ends = ["LAMELLA_API_BEGIN\nnamespace lamella {", "} // namespace lamella\nLAMELLA_API_END\n"]
            if "\nnamespace " in text and any(text.count(end) != 1 for end in ends):
                name = path.relative_to(self.root).as_posix()
                self.findings.append(f"{name}: the namespace must stand between LAMELLA_API_BEGIN and LAMELLA_API_END")

    def check_table(self):
        level = {module: level for level, modules in enumerate(LEVELS) for module in modules}
        for module, below in MODULES.items():
            for other in below:
                if module in ENGINE and other not in ENGINE:
                    self.findings.append(f"check_levels: {module} is part of the engine, {other} is not")
                if level[other] >= level[module]:
                    self.findings.append(f"check_levels: {module} may not be allowed {other}: not on a level below")

    def check_file(self, path):
        name = path.relative_to(self.root).as_posix()
        # Line breaks of comments are kept, so that line numbers stay right.
        text = COMMENT.sub(lambda m: "\n" * m.group().count("\n"), path.read_text(encoding="utf-8"))
        for match in INCLUDE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            angled, quoted = match.groups()
            complaint = self.judge(name, angled, quoted)
            if complaint:
                self.findings.append(f"{name}:{line}: {complaint}")

    def judge(self, name, angled, quoted):
        target = self.resolve(name, angled or quoted, quoted is not None)
        if target is None:
            if quoted is not None:
                return f'"{quoted}" is no file of this project; other headers are included with <>'
            return self.judge_foreign(name, angled)
        return self.judge_own(name, target)

    def resolve(self, name, header, quoted):
        """Returns the file of this project that an include names, relative to the root, or None."""
        places = ["include", "src", "tests", "."] if quoted else ["include"]
        if quoted:
            places.insert(0, str(Path(name).parent))
        for place in places:
            candidate = (self.root / place / header).resolve()
            if candidate.is_file() and candidate.is_relative_to(self.root):
                return candidate.relative_to(self.root).as_posix()
        return None

    def judge_foreign(self, name, header):
        if header.startswith("lamella/"):
            return f"<{header}> is no header of this project"
        if name not in THIRD_PARTY_OF_CONSUMERS.get(header, name).split():
            return f"<{header}> may be visible in {THIRD_PARTY_OF_CONSUMERS[header]} only"
        if header in STANDARD or not name.startswith(("include/", "src/")):
            return None
        if name.endswith(".h") and header in STANDARD_OF_C:
            return None
        if name.startswith("include/"):
            return f"public headers need only the standard library, not <{header}>"
        if SYSTEM.match(header):
            return None if name.startswith(SYSTEM_MODULE) else f"only {SYSTEM_MODULE} knows the operating system"
        library = header.split("/")[0]
        if library in THIRD_PARTY_ANYWHERE:
            return None
        home = THIRD_PARTY.get(library)
        if home is None:
            return f"<{header}> belongs to no library that tools/check_levels.py knows"
        if name not in home.split():
            return f"<{header}> may be visible in {home} only"
        return None

    def judge_own(self, name, target):
        public = target.startswith("include/lamella/")
        user, used = module_of(name), module_of(target)
        parts = name.split("/")

        if target.startswith("tests/"):
            return None if parts[0] == "tests" else "only tests may include what belongs to the tests"
        if target.startswith("parts/"):
            return "the library knows no test bodies" if parts[0] in ("include", "src") else None
        if parts[0] in ("include", "src"):
            if user == "main header":
                return None if public else "a main header includes public headers only"
            if used == "main header":
                return "a main header is for other programs; include the header of the module"
            if parts[0] == "include" and not public:
                return f"a public header may not include the private {target}"
            if used != user and used not in MODULES[user]:
                return f"{user} may not include {target}: {used} is not below it"
            return self.judge_folder(name, target)
        if public or not target.startswith("src/") or name in BENCHMARKS_OF_PRIVATE:
            return None
        if parts[0] == "app" and SYSTEM_OF_PROGRAMS.match(target):
            return None
        if parts[0] == "tests" and user in MODULES:
            if used == user or used in MODULES[user]:
                return None
            return f"tests of {user} may not open {target}: {used} is not below it"
        return f"only public headers may be included here, not {target}"

    def judge_folder(self, name, target):
        """Headers in a folder of a module may be included only there, so engines in different folders are independent."""
        folder = Path(target).parent
        if target.startswith("src/") and len(folder.parts) > 2 and Path(name).parent != folder and folder.as_posix() != SHARED_FOLDER:
            return f"only sources of {folder.as_posix()} may include {target}"
        return None


def module_of(name):
    """Returns the module of a path: "core", ..., "main header", or None outside the library and its tests."""
    parts = name.split("/")
    if parts[0] == "include":
        return parts[2] if len(parts) > 3 else "main header"
    if parts[0] in ("src", "tests") and len(parts) > 2:
        return parts[1]
    return None


def main(arguments):
    root = arguments[1] if len(arguments) > 1 else Path(__file__).resolve().parent.parent
    findings = Architecture(root).check()
    for finding in findings:
        print(finding)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))

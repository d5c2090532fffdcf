#!/usr/bin/env python3
"""A root in which nothing is but what Debian's packages say they need.

It is this machine's own root under an overlay that hides the files of all packages but those named and what they depend
on, the package manager's knowledge of them included: no download, and all that is done there is gone with it.

    unshare --mount clean_root.py FOLDER PACKAGE,... -- COMMAND...

runs COMMAND there; FOLDER is what it has of this machine, as /given. Ends with MAY_NOT where the machine allows no such
root.
"""
import os
import pathlib
import re
import stat
import subprocess
import sys

MAY_NOT = 77
STATUS = pathlib.Path("/var/lib/dpkg/status")
# Where a file that nobody depends on could be found by accident.
SEARCHED = ("/usr/include/", "/usr/lib/", "/usr/bin/", "/usr/sbin/", "/usr/share/cmake", "/usr/share/pkgconfig/",
            "/usr/share/eigen3/", "/usr/share/python")
HIDDEN = ("/usr/local", "/opt", "/home", "/root", "/tmp", "/run", "/srv")


def fields_of(paragraph):
    return dict(re.findall(r"^([\w-]+): *(.*(?:\n .*)*)", paragraph, re.MULTILINE))


def names_in(relation):
    """Depends: a | b (>= 1), c:any -> [[a, b], [c]]"""
    return [[re.match(r"[\w.+-]+", choice.strip())[0] for choice in group.split("|")]
            for group in relation.split(",") if group.strip()]


def closure(packages, wanted):
    providers = {}
    for name, fields in packages.items():
        for group in [[[name]], names_in(fields.get("Provides", ""))]:
            for names in group:
                providers.setdefault(names[0], []).append(name)
    found = set()
    waiting = [[name] for name in wanted]
    waiting += [[name] for name, fields in packages.items() if fields.get("Essential") == "yes"]
    while waiting:
        choices = waiting.pop()
        package = next((p for choice in choices for p in providers.get(choice, [])), None)
        if package is None:
            sys.exit(f"clean_root.py: none of {', '.join(choices)} is installed here")
        if package not in found:
            found.add(package)
            for relation in ("Depends", "Pre-Depends"):
                waiting += names_in(packages[package].get(relation, ""))
    return found


def files_of(package, architecture):
    for name in (package, f"{package}:{architecture}"):
        path = pathlib.Path(f"/var/lib/dpkg/info/{name}.list")
        if path.is_file():
            return {re.sub(r"^/(bin|sbin|lib\w*)/", r"/usr/\1/", file) for file in path.read_text().splitlines()}
    return set()


def hide_all_but(kept, packages, upper):
    keep = set().union(*(files_of(name, packages[name]["Architecture"]) for name in kept))
    others = set().union(*(files_of(name, packages[name]["Architecture"]) for name in packages.keys() - kept))
    for file in others - keep:
        if file.startswith(SEARCHED) and os.path.lexists(file) and not os.path.isdir(file):
            hidden = pathlib.Path(str(upper) + file)
            hidden.parent.mkdir(parents=True, exist_ok=True)
            os.mknod(hidden, stat.S_IFCHR, 0)  # overlayfs: there is no such file


def main():
    given, wanted = pathlib.Path(sys.argv[1]), sys.argv[2].split(",")
    command = sys.argv[sys.argv.index("--") + 1:]

    def mount(*arguments):
        if subprocess.run(["mount", *map(str, arguments)]).returncode != 0:
            sys.exit(MAY_NOT)

    paragraphs = {}
    for paragraph in STATUS.read_text().split("\n\n"):
        fields = fields_of(paragraph)
        if fields.get("Status", "").endswith(" installed"):
            paragraphs[fields["Package"]] = paragraph
    packages = {name: fields_of(paragraph) for name, paragraph in paragraphs.items()}
    kept = closure(packages, wanted)

    # In memory: an overlay cannot write to another one.
    mount("--make-rprivate", "/")
    mount("-t", "tmpfs", "palpate", "/mnt")
    upper, work, root = (pathlib.Path("/mnt") / name for name in ("upper", "work", "root"))
    for folder in (upper, work, root):
        folder.mkdir()
    try:
        hide_all_but(kept, packages, upper)
    except PermissionError:
        sys.exit(MAY_NOT)
    (upper / "var/lib/dpkg").mkdir(parents=True)
    (upper / "var/lib/dpkg/status").write_text("\n\n".join(paragraphs[name] for name in sorted(kept)) + "\n\n")
    mount("-t", "overlay", "overlay", "-o", f"lowerdir=/,upperdir={upper},workdir={work}", root)
    for folder in (*HIDDEN, *(os.environ[name] for name in ("PALPATE_SOURCE", "PALPATE_BUILD"))):
        if (root / folder[1:]).is_dir():
            mount("-t", "tmpfs", "none", root / folder[1:])
    mount("--rbind", "/dev", root / "dev")
    mount("-t", "proc", "proc", root / "proc")
    (root / "given").mkdir()
    mount("--bind", given, root / "given")
    os.chroot(root)
    os.chdir("/")
    # Where a library of several makers was another's than that of the packages that are left.
    for link in pathlib.Path("/etc/alternatives").glob("*.so*"):
        if not link.exists():
            subprocess.run(["update-alternatives", "--quiet", "--auto", link.name], check=True)
    os.execve("/usr/bin/env", ["env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/tmp", "LC_ALL=C.UTF-8",
                               "DEBIAN_FRONTEND=noninteractive", *command], {})


if __name__ == "__main__":
    main()

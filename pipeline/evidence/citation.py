"""Make CITATION.cff, codemeta.json and .zenodo.json from pyproject.toml.

    python -m pipeline.evidence.citation

Name, description, licence, authors and keywords are those of [project], the version is that of the
package; date, reference and, once there are any, DOI and ORCIDs stand in
[tool.viscoroll.citation], and the address in [project.urls].  "make release-check" compares.
"""

import json
import sys
import tomllib

import viscoroll as vr
from viscoroll.core.files import write_text

from ..stage import ROOT, Row, said, told

MESSAGE = "If you use this software, please cite it and the paper whose equations it implements."


def facts() -> Row:
    """What the files say: [project], over it [tool.viscoroll.citation], and the version."""
    content = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    own = content["tool"]["viscoroll"]["citation"]
    return content["project"] | own | {"version": vr.__version__}


def _quoted(text):
    """A scalar of YAML: JSON's strings are among them."""
    return json.dumps(text, ensure_ascii=False)


def _person(name, indent="  "):
    """Lines of a person, who has given and family names."""
    given, _, family = name.rpartition(" ")
    return [f"{indent}- family-names: {family}", f"{indent}  given-names: {given}"]


def cff(of: Row) -> str:
    """CITATION.cff, Citation File Format 1.2.0."""
    reference = of["reference"]
    orcids = of.get("orcid", {})
    lines = [
        "# Made from pyproject.toml by pipeline.evidence.citation.",
        "cff-version: 1.2.0",
        f"message: {MESSAGE}",
        f"title: {of['name']}",
        f"abstract: {_quoted(of['description'])}",
        "type: software",
        f"version: {of['version']}",
        f"date-released: {_quoted(of['date'])}",
        f"license: {of['license']}",
        *([f"doi: {of['doi']}"] if "doi" in of else []),
        *([f"repository-code: {_quoted(of['urls']['Repository'])}"] if "urls" in of else []),
        "authors:",
    ]
    for name in (author["name"] for author in of["authors"]):
        if name in orcids:
            lines += [*_person(name), f"    orcid: https://orcid.org/{orcids[name]}"]
        else:
            lines.append(f"  - name: {name}")
    lines += ["keywords:", *(f"  - {word}" for word in of["keywords"]), "references:"]
    lines += ["  - type: article", f"    title: {reference['title']}", "    authors:"]
    for name in reference["authors"]:
        lines += _person(name, "      ")
    lines += [f"    {key}: {reference[key]}" for key in ("journal", "year", "doi")]
    return "\n".join([*lines, ""])


def codemeta(of: Row) -> str:
    """codemeta.json, CodeMeta 3.0."""
    orcids = of.get("orcid", {})
    people = [
        {"@type": "Person", "@id": f"https://orcid.org/{orcids[each['name']]}"} | each
        if each["name"] in orcids
        else {"@type": "Organization"} | each
        for each in of["authors"]
    ]
    reference = of["reference"]
    article = {
        "@type": "ScholarlyArticle",
        "@id": f"https://doi.org/{reference['doi']}",
        "name": reference["title"],
    }
    found = {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": of["name"],
        "description": of["description"],
        "version": of["version"],
        "datePublished": of["date"],
        "license": f"https://spdx.org/licenses/{of['license']}",
        "programmingLanguage": "Python",
        "runtimePlatform": f"Python {of['requires-python']}",
        "author": people,
        "keywords": of["keywords"],
        "softwareRequirements": of["dependencies"],
        "referencePublication": article,
    }
    found |= {"identifier": f"https://doi.org/{of['doi']}"} if "doi" in of else {}
    found |= {"codeRepository": of["urls"]["Repository"]} if "urls" in of else {}
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"


def zenodo(of: Row) -> str:
    """.zenodo.json, metadata of a deposit."""
    orcids = of.get("orcid", {})
    creators = [
        {"name": each["name"]} | ({"orcid": orcids[each["name"]]} if each["name"] in orcids else {})
        for each in of["authors"]
    ]
    related = {
        "identifier": of["reference"]["doi"],
        "relation": "references",
        "resource_type": "publication-article",
        "scheme": "doi",
    }
    found = {
        "title": f"{of['name']} {of['version']}",
        "upload_type": "software",
        "description": of["description"],
        "version": of["version"],
        "publication_date": of["date"],
        "access_right": "open",
        "license": of["license"],
        "creators": creators,
        "keywords": of["keywords"],
        "related_identifiers": [related],
    }
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"


FILES = {"CITATION.cff": cff, "codemeta.json": codemeta, ".zenodo.json": zenodo}


def made() -> dict[str, str]:
    """Return the text of every file by its name."""
    of = facts()
    return {name: text(of) for name, text in FILES.items()}


def main():
    said(__doc__).parse_args()

    def write():
        for name, text in made().items():
            write_text(ROOT / name, text)

    return told("citation", write)


if __name__ == "__main__":
    sys.exit(main())

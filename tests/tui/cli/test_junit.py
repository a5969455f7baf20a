from xml.etree import ElementTree

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tui.cli.junit import Check, write_junit


@given(st.text(), st.text(), st.none() | st.text())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_text_makes_a_report_that_can_be_parsed(tmp_path, name, said, failure):
    write_junit(
        tmp_path / "report.xml", "suite", [Check(name, said, failure), Check("other", "", None)]
    )
    suite = ElementTree.parse(tmp_path / "report.xml").getroot()
    assert (suite.attrib["tests"], suite.attrib["failures"]) == ("2", str(int(failure is not None)))
    assert len(suite.findall("testcase")) == 2
    assert (suite.find("testcase/failure") is not None) is (failure is not None)

"""Small maps of one road in the formats that are not among the fixtures."""

from __future__ import annotations

from tests.formats.commonroad.scenario_text import bound, lanelet, scenario


def lanelet2() -> str:
    """Return a road of two lanes each way with a sign, a stop line and a crossing, in local coordinates and on the globe."""
    nodes: list[str] = []
    ways: list[str] = []
    relations: list[str] = []

    def way(points: list[tuple[float, float]], kind: str, style: str) -> int:
        refs = []
        for x, y in points:
            nodes.append(
                f'<node id="{len(nodes) + 1}" lat="{49.0 + y / 111_000:.11f}" lon="{8.4 + x / 73_000:.11f}">'
                f'<tag k="local_x" v="{x}"/><tag k="local_y" v="{y}"/></node>'
            )
            refs.append(f'<nd ref="{len(nodes)}"/>')
        number = 1000 + len(ways)
        ways.append(f'<way id="{number}">{"".join(refs)}<tag k="type" v="{kind}"/><tag k="subtype" v="{style}"/></way>')
        return number

    def relation(members: str, **tags: str) -> int:
        said = "".join(f'<tag k="{key}" v="{value}"/>' for key, value in tags.items())
        number = 2000 + len(relations)
        relations.append(f'<relation id="{number}">{members}{said}</relation>')
        return number

    def lane(left: int, right: int, more: str = "", **tags: str) -> int:
        members = f'<member type="way" ref="{left}" role="left"/><member type="way" ref="{right}" role="right"/>{more}'
        told = {"type": "lanelet", "subtype": "road", "location": "urban", "one_way": "yes", "region": "de"}
        return relation(members, **told, **tags)

    lines = {
        y: way([(0.0, y), (30.0, y + 0.5), (60.0, y)], "line_thin", "dashed" if y else "solid")
        for y in (-7.0, -3.5, 0.0, 3.5)
    }
    sign = way([(20.0, -8.0), (21.0, -8.0)], "traffic_sign", "de274")
    stop = way([(55.0, 0.0), (55.0, -3.5)], "stop_line", "")
    element = relation(
        f'<member type="way" ref="{sign}" role="refers"/><member type="way" ref="{stop}" role="ref_line"/>',
        type="regulatory_element", subtype="traffic_sign",
    )  # fmt: skip
    under = f'<member type="relation" ref="{element}" role="regulatory_element"/>'
    lane(lines[0.0], lines[-3.5], under, speed_limit="50")
    lane(lines[-3.5], lines[-7.0])
    lane(lines[0.0], lines[3.5])
    zebra = [way([(x, -9.0), (x, 9.0)], "zebra_marking", "") for x in (22.0, 25.0)]
    relation(
        f'<member type="way" ref="{zebra[0]}" role="left"/><member type="way" ref="{zebra[1]}" role="right"/>',
        type="lanelet", subtype="crosswalk", location="urban", one_way="no", region="de",
    )  # fmt: skip
    return "<?xml version='1.0'?>\n<osm version='0.6'>\n" + "\n".join([*nodes, *ways, *relations]) + "\n</osm>\n"


def commonroad() -> str:
    """Return lanelets with a sign, a stop line, a crossing, a light and a junction."""
    point = "<point><x>{}</x><y>{}</y></point>"
    stop = f"<stopLine>{point.format(45, 1.75)}{point.format(45, -1.75)}</stopLine>"
    return scenario(
        lanelet(1, 0.0, f'<successor ref="2"/><laneletType>country</laneletType><trafficSignRef ref="90"/>{stop}'),
        lanelet(2, 0.0, '<laneletType>interstate</laneletType><trafficLightRef ref="91"/>', x=50.0),
        lanelet(3, -3.5, '<laneletType>sidewalk</laneletType><adjacentLeft ref="1" drivingDir="same"/>'),
        f'<lanelet id="4">{bound("leftBound", [(20.0, 5.0), (20.0, -5.0)])}{bound("rightBound", [(17.0, 5.0), (17.0, -5.0)])}'
        "<laneletType>crosswalk</laneletType></lanelet>",
        '<trafficSign id="90"><trafficSignElement><trafficSignID>274</trafficSignID><additionalValue>13.9</additionalValue>'
        f"</trafficSignElement><position>{point.format(10, -4)}</position></trafficSign>",
        '<trafficLight id="91"><cycle><cycleElement><duration>30</duration><color>red</color></cycleElement><cycleElement>'
        f"<duration>20</duration><color>green</color></cycleElement></cycle><position>{point.format(10, -4)}</position></trafficLight>",
        '<intersection id="80"><incoming id="81"><incomingLanelet ref="1"/><successorsStraight ref="2"/></incoming></intersection>',
    )


def sumo() -> str:
    """Return a main road that a side road meets at a light."""

    def edge(name: str, ends: str, *shapes: str) -> str:
        lanes = "".join(
            f'<lane id="{name}_{i}" index="{i}" speed="13.89" length="50" width="3" shape="{shape}"/>'
            for i, shape in enumerate(shapes)
        )
        return f'<edge id="{name}" {ends}>{lanes}</edge>'

    def link(start: str, end: str, way: str, more: str = "") -> str:
        return f'<connection from="{start}" to="{end}" fromLane="0" toLane="0" dir="{way}" state="M" {more}/>'

    return "".join(
        (
            '<?xml version="1.0"?>\n<net version="1.20">',
            edge("we", 'from="w" to="c"', "0,-4.8 50,-4.8", "0,-1.6 50,-1.6"),
            edge("ea", 'from="c" to="e"', "60,-4.8 110,-4.8", "60,-1.6 110,-1.6"),
            edge("ew", 'from="e" to="c"', "110,1.6 60,1.6"),
            edge("wa", 'from="c" to="w"', "50,1.6 0,1.6"),
            edge("st", 'from="s" to="c"', "56.6,-60 56.6,-10"),
            edge(":c_0", 'function="internal"', "50,-4.8 60,-4.8"),
            edge(":c_1", 'function="internal"', "60,1.6 50,1.6"),
            edge(":c_2", 'function="internal"', "56.6,-10 57,-7.5 58.4,-5.3 60,-4.8"),
            '<tlLogic id="t" type="static" programID="0" offset="0"><phase duration="30" state="GGr"/><phase duration="5" state="yyr"/>',
            '<phase duration="20" state="rrG"/></tlLogic>',
            '<junction id="c" type="traffic_light" x="55" y="0"/><junction id="e" type="dead_end" x="110" y="0"/>',
            link("we", "ea", "s", 'via=":c_0_0" tl="t" linkIndex="0"'),
            link("ew", "wa", "s", 'via=":c_1_0" tl="t" linkIndex="1"'),
            link("st", "ea", "r", 'via=":c_2_0" tl="t" linkIndex="2"'),
            link(":c_0", "ea", "s"), link(":c_1", "wa", "s"), link(":c_2", "ea", "r"),
            "</net>",
        )
    )  # fmt: skip

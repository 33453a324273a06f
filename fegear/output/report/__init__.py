"""``report.html``: one self-contained page, with plots to point at, every table to download, and sources.

`write_report` makes the page of a run. Any other command makes a page of its own through the same door::

    from fegear.output.report import Page, Section, write_page
    from fegear.output.report.blocks import DataTable, Facts, Notes, Paragraph, Plot, Still
    from fegear.engine.figure import Axis, Figure, Panel, Points

    points = Points(seconds, error, "finite elements", "blue", notes=labels)
    panel = Panel(Axis("time", "s", log=True), Axis("relative error", log=True), (points,))
    figure = Figure("cost", "Error against time", "Each point is one setting.", (panel,))
    page = Page(
        title="What accuracy costs",
        note="one line below the title",
        sections=(Section("Error against time", (Paragraph("..."), Plot(figure), DataTable(table))),),
        tables=(table,),             # every table that a DataTable shows; written once, as its CSV
        name="nasa_four_square",     # of the files that the page offers for download
    )
    write_page(folder / "cost.html", page)

The page holds each table once, as the bytes of its CSV file; plots carry their own numbers, as plotly's JSON. Nothing
is fetched from anywhere. plotly.js comes from plotly's wheel; plotly's Python is never imported.
"""

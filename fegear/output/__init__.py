"""What a run leaves behind: tables, summary, dataset, pictures, report, exports. Nothing numerical imports this."""

"""Reports for people: the progress line, curves and their page, contact sheets and videos."""
